// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "pipeline/quality/gaussian_sums.hpp"
#include "pipeline/quality/kernel.hpp"
#include "pipeline/quality/points.hpp"
#include "pipeline/quality/registry.hpp"

namespace crisp {

/// The neighbours of a run of points, one list after the other.
struct Neighbours {
  std::vector<std::size_t> begin;        ///< of each point's list; one more than points
  std::vector<std::uint32_t> index;      ///< of each neighbour
  std::vector<double> squared_distance;  ///< [m²] to each neighbour
};

/// A thread-safe index of points for neighbour queries.
class NeighbourIndex {
 public:
  virtual ~NeighbourIndex() = default;

  /// For each of the points first … last − 1: all points nearer than the radius, itself included, in
  /// ascending order of their index. Replaces what `result` holds.
  virtual void near(std::size_t first, std::size_t last, Neighbours& result) const = 0;
};

/// A way to find neighbours. It may keep what it learnt from one call for the next.
class Search {
 public:
  virtual ~Search() = default;

  /// @param points  must outlive the index
  /// @param radius  [m] > 0
  virtual std::unique_ptr<NeighbourIndex> index(const PointsView& points, double radius) const = 0;

  /// RQE's sums over all pairs nearer than the kernel's radius. By default from the
  /// lists of index(), in double precision; `tested` then counts the neighbours listed.
  ///
  /// @param weights  one a point, about 1
  virtual GaussianSums sums(const PointsView& points, std::span<const double> weights,
                            const TruncatedGaussian& kernel, const RequestedSums& requested);
};

using SearchRegistry = Registry<Search>;

/// "flann" (k-d tree, the reference), "grid" (fast) and "exact" (all pairs, for tests).
void register_built_in(SearchRegistry& registry);

}  // namespace crisp
