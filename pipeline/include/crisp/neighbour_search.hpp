// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include <crisp/factory_registry.hpp>
#include <crisp/points.hpp>

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

/// The kernel between two points of a cloud whose points are Gaussians of width σ each: the isotropic normal
/// density of variance 2σ² in three dimensions, lowered by its value at the cut-off radius and 0 beyond.
struct TruncatedGaussian {
  TruncatedGaussian(double width, double cutoff);  ///< @throws Error unless 1e-6 ≤ σ ≤ 1e6 m, 1 ≤ cutoff ≤ 12

  double sigma = 0;     ///< [m]
  double radius = 0;    ///< [m] R
  double exponent = 0;  ///< [1/m²] 1/(4σ²): G(d) = peak · exp(−exponent · d²)
  double peak = 0;      ///< [1/m³] G(0)
  double floor = 0;     ///< G(R) / G(0)
};

/// The sums of a cloud's entropy, over the pairs of points nearer than a kernel's radius R.
struct GaussianSums {
  double kernel = 0;  ///< Σᵢ Σⱼ wᵢ wⱼ (G(xᵢ − xⱼ) − G(R)) / G(0), over ordered pairs and i = j
  Vectors gradient;  ///< of point i: wᵢ Σⱼ wⱼ G(xᵢ − xⱼ)/G(0) · (xᵢ − xⱼ) [m]; empty: unwanted
  double error = 0;          ///< `kernel` with the whole G(xᵢ − xⱼ) lies within ± error; 0: unwanted
  std::uint64_t pairs = 0;   ///< i < j; 0 where no pairs were formed
  std::uint64_t tested = 0;  ///< distances computed to find them
};

/// Sums to compute in addition to `kernel`.
struct RequestedSums {
  bool gradient = true;  ///< the sum's derivative with respect to each point
  bool error = true;     ///< a bound of what the cut-off leaves out
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
