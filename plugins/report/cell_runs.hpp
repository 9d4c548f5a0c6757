// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include "pipeline/quality/spatial_order.hpp"

namespace crisp::report {

/// The points of one cell: places `begin` … `end` − 1 along a Morton curve.
struct CellRun {
  std::size_t begin = 0;
  std::size_t end = 0;

  std::size_t size() const { return end - begin; }
};

/// The cells that hold points, along the curve.
/// @param levels  how often the cells' side is doubled before
std::vector<CellRun> cell_runs(const quality::SpatialOrder& order, unsigned levels);

}  // namespace crisp::report
