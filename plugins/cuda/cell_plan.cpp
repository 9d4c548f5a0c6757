// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/cuda/cell_plan.hpp"

#include <algorithm>
#include <array>

#include "pipeline/quality/blocks.hpp"

namespace crisp::cuda {
namespace {

constexpr std::size_t kCellBlock = 4096;  // cells
constexpr double kReach = 1 << 16;  // cells from the median to where the lattice ends, see spatial_order()
constexpr double kSurelyWithin = 0.99 * kReach;

struct Cells {
  std::vector<std::uint64_t> key;  // ascending
  std::vector<SlotRange> slots;
};

Cells occupied_cells(const quality::SpatialOrder& order) {
  Cells cells;
  for (std::uint32_t slot = 0; slot < order.cell.size(); ++slot) {
    if (slot == 0 || order.cell[slot] != order.cell[slot - 1]) {
      cells.key.push_back(order.cell[slot]);
      cells.slots.push_back({slot, slot});
    }
    cells.slots.back().last = slot + 1;
  }
  return cells;
}

/// The slots of a cell and of those around it, in ascending order; what is adjacent is one range.
std::vector<SlotRange> near_slots(const Cells& cells, std::size_t cell) {
  const auto [x, y, z] = quality::cell_of(cells.key[cell]);
  std::vector<SlotRange> found;
  for (const std::int64_t i : {x - 1, x, x + 1}) {
    for (const std::int64_t j : {y - 1, y, y + 1}) {
      for (const std::int64_t k : {z - 1, z, z + 1}) {
        const auto key = std::ranges::lower_bound(cells.key, quality::cell_key({i, j, k}));
        if (key == cells.key.end() || *key != quality::cell_key({i, j, k})) continue;
        found.push_back(cells.slots[static_cast<std::size_t>(key - cells.key.begin())]);
      }
    }
  }
  std::ranges::sort(found, {}, &SlotRange::first);
  std::vector<SlotRange> merged;
  for (const SlotRange& range : found) {
    if (!merged.empty() && merged.back().last == range.first) {
      merged.back().last = range.last;
    } else {
      merged.push_back(range);
    }
  }
  return merged;
}

double extent(std::span<const double> values) {
  const auto [low, high] = std::ranges::minmax(values);
  return high - low;
}

}  // namespace

CellPlan plan_cells(const PointsView& points, double side) {
  CellPlan plan;
  plan.order = quality::spatial_order(points, side);
  plan.near_begin = {0};
  if (points.size() == 0) return plan;
  for (const auto axis : {points.x, points.y, points.z}) {
    plan.needs_double = plan.needs_double || extent(axis) > kSurelyWithin * side;
  }

  const Cells cells = occupied_cells(plan.order);
  std::vector<std::vector<SlotRange>> lists(cells.key.size());
  quality::for_blocks(lists.size(), kCellBlock, [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t cell = begin; cell < end; ++cell) lists[cell] = near_slots(cells, cell);
  });
  for (std::size_t cell = 0; cell < lists.size(); ++cell) {
    const auto [begin, end] = cells.slots[cell];
    for (std::uint32_t slot = begin; slot < end; slot += std::min(kLanes, end - slot)) {
      plan.units.push_back({{slot, slot + std::min(kLanes, end - slot)}, static_cast<std::uint32_t>(cell)});
    }
    for (const SlotRange& range : lists[cell]) {
      plan.near.push_back(range);
      plan.tested += std::uint64_t{end - begin} * (range.last - range.first);
    }
    plan.near_begin.push_back(plan.near.size());
  }
  return plan;
}

}  // namespace crisp::cuda
