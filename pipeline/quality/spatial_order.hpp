// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <crisp/points.hpp>

namespace crisp::quality {

/// Cubic cells, numbered along a Morton curve.
struct CellLattice {
  std::array<double, 3> low{};  ///< [m] corner of the cell 0
  double side = 1;              ///< [m]

  using Cell = std::array<std::int64_t, 3>;  ///< its number along each axis
  Cell cell(double x, double y, double z) const;
};

/// A cell's number along the curve; cells below 0 or beyond 2¹⁷ − 1 along an axis share one that no point
/// has.
std::uint64_t cell_key(const CellLattice::Cell& cell);
CellLattice::Cell cell_of(std::uint64_t key);

/// Points in the order of a Morton curve: what is near in space is mostly near in it.
struct SpatialOrder {
  CellLattice lattice;
  std::vector<std::uint32_t> index;  ///< of the points, along the curve
  std::vector<std::uint64_t> cell;   ///< key of each one's cell, along the curve
};

/// Sorts points along a Morton curve through cells, finely enough that the order within a cell still is one.
///
/// @param side  [m] of a cell. The lattice reaches 2¹⁷ cells from end to end about the median of the points;
///              what lies farther out shares the outermost cells, which stay neighbours of what they were.
/// @throws Error for more points than 32 bits can number
SpatialOrder spatial_order(const PointsView& points, double side);

}  // namespace crisp::quality
