// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include <crisp/points.hpp>

#include "pipeline/quality/spatial_order.hpp"
#include "plugins/cuda/rqe_kernel.hpp"

namespace crisp::cuda {

/// Which points are summed side by side, and against which. A slot is a place in `order`.
struct CellPlan {
  quality::SpatialOrder order;            ///< by cells
  std::vector<Unit> units;                ///< cell by cell
  std::vector<SlotRange> near;            ///< see PlanView
  std::vector<std::uint64_t> near_begin;  ///< see PlanView
  std::uint64_t tested = 0;               ///< distances that its sums will compute
  bool needs_double = false;  ///< it reaches so far that a cell may hold points that are far from one another
};

/// @param side    [m] of the cells: points that are nearer than that are neighbours
/// @throws Error  for more points than 32 bits can number
CellPlan plan_cells(const PointsView& points, double side);

}  // namespace crisp::cuda
