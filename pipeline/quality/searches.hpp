// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "pipeline/quality/search.hpp"
#include "pipeline/quality/tiles.hpp"

namespace crisp {

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

/// Tiles of points along a Morton curve through cells, see Tiles. Sums are in single precision (see
/// sum_over_tiles), and the order of the points is kept from one call to the next while it serves: sums of
/// points that have moved a little skip the sorting, and are as exact.
class GridSearch final : public Search {
 public:
  std::unique_ptr<NeighbourIndex> index(const PointsView& points, double radius) const override;
  GaussianSums sums(const PointsView& points, std::span<const double> weights,
                    const TruncatedGaussian& kernel, bool gradient) override;

 private:
  bool still_serves(const PointsView& points, double radius);

  std::optional<Tiles> tiles_;
  double tested_when_new_ = 0;  // distances that sums cost with fresh tiles
  double tested_last_ = 0;
};

}  // namespace crisp
