// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "pipeline/quality/points.hpp"

namespace crisp {

/// Points in the order of a Morton curve: what is near in space is mostly near in it.
struct SpatialOrder {
  std::vector<std::uint32_t> index;  ///< of the points, along the curve
  std::vector<std::uint64_t> cell;   ///< of each, along the curve: equal for points of the same cell
};

/// Sorts points along a Morton curve through cells, finely enough that the order within a cell still is one.
///
/// @param side  [m] of a cell. The lattice reaches 2¹⁷ cells from end to end about the median of the points;
///              what lies farther out shares the outermost cells, which stay neighbours of what they were.
/// @throws Error for more points than 32 bits can number
SpatialOrder spatial_order(const PointsView& points, double side);

}  // namespace crisp
