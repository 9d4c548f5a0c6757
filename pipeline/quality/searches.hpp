// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include <crisp/neighbour_search.hpp>

#include "pipeline/quality/tiles.hpp"

namespace crisp::quality {

/// FLANN's k-d tree, exact. The reference that the mission names.
class FlannSearch final : public Search {
 public:
  std::unique_ptr<NeighbourIndex> index(const PointsView& points, double radius) const override;
};

/// All pairs: O(n²).
class ExactSearch final : public Search {
 public:
  std::unique_ptr<NeighbourIndex> index(const PointsView& points, double radius) const override;
};

/// The fast search: tiles of points along a Morton curve through cells, see Tiles. Sums are in single
/// precision (see sum_over_tiles); where a point has so many neighbours that it pays, they are not taken over
/// pairs but on a lattice (see sum_on_lattice). The choice and the order of the points are kept from one call
/// to the next for as many points and the same radius: sums of points that have moved a little skip the
/// sorting, and are as exact.
class GridSearch final : public Search {
 public:
  std::unique_ptr<NeighbourIndex> index(const PointsView& points, double radius) const override;
  GaussianSums sums(const PointsView& points, std::span<const double> weights,
                    const TruncatedGaussian& kernel, const RequestedSums& requested) override;

 private:
  GaussianSums over_tiles(const PointsView& points, std::span<const double> weights,
                          const TruncatedGaussian& kernel, const RequestedSums& requested);

  struct Last {
    std::size_t points = 0;
    double radius = 0;
    bool on_lattice = false;
    double tested_when_new = 0;  // distances that sums cost with fresh tiles
    double tested = 0;
  };
  std::optional<Last> last_;
  std::optional<Tiles> tiles_;
};

}  // namespace crisp::quality
