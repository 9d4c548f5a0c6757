// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/quality/tiles.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "pipeline/quality/axes.hpp"
#include "pipeline/quality/blocks.hpp"

namespace crisp::quality {
namespace {

constexpr std::size_t kCutBlock = 65536;     // points
constexpr std::size_t kGatherBlock = 16384;  // points
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Each box of a level from the kFanOut below it.
void set_boxes(const Boxes& below, Boxes& level) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (std::size_t i = 0; i * Tiles::kFanOut < below.size(); ++i) {
      const auto some = [&](const std::vector<double>& all) {
        return std::span(all).subspan(i * Tiles::kFanOut, Tiles::kFanOut);
      };
      level.low[axis][i] = *std::ranges::min_element(some(below.low[axis]));
      level.high[axis][i] = *std::ranges::max_element(some(below.high[axis]));
    }
  }
}

}  // namespace

Boxes::Boxes(std::size_t n) {
  for (auto& axis : low) axis.assign(n, kInfinity);
  for (auto& axis : high) axis.assign(n, -kInfinity);
}

double squared_gap(const Boxes& a, std::size_t i, const Boxes& b, std::size_t j) {
  // Rounding is monotone, so that no pair of points is computed to be nearer than their boxes are.
  double sum = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double gap = std::max({0.0, a.low[axis][i] - b.high[axis][j], b.low[axis][j] - a.high[axis][i]});
    sum += gap * gap;
  }
  return sum;
}

Tiles::Tiles(const PointsView& points, double reach, std::vector<std::uint32_t> order)
    : reach_(reach), order_(std::move(order)) {
  gather(points);
  cut();
  std::size_t boxes = size();
  do {
    const std::size_t above = (boxes + kFanOut - 1) / kFanOut;
    levels_.emplace_back(above * kFanOut);
    boxes = above;
  } while (boxes > 1);
  levels_.emplace_back(boxes);
  set_tile_boxes();
}

void Tiles::gather(const PointsView& points) {
  const auto coordinates = axes(points);
  for (auto& axis : at_) axis.resize(order_.size());
  for_blocks(order_.size(), kGatherBlock, [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      for (std::size_t slot = begin; slot < end; ++slot) at_[axis][slot] = coordinates[axis][order_[slot]];
    }
  });
}

void Tiles::cut() {
  std::vector<std::vector<std::uint32_t>> begins(blocks_of(order_.size(), kCutBlock));
  for_blocks(order_.size(), kCutBlock, [&](std::size_t block, std::size_t begin, std::size_t end) {
    begins[block] = cut(static_cast<std::uint32_t>(begin), static_cast<std::uint32_t>(end));
  });
  for (const auto& some : begins) begin_.insert(begin_.end(), some.begin(), some.end());
  begin_.push_back(static_cast<std::uint32_t>(order_.size()));
}

std::vector<std::uint32_t> Tiles::cut(std::uint32_t begin, std::uint32_t end) const {
  constexpr double kLargest = 1.75;  // of the reach: tiles well filled where points are few, small elsewhere
  std::vector<std::uint32_t> begins;
  std::array<double, 3> low{};
  std::array<double, 3> high{};
  for (std::uint32_t slot = begin; slot < end; ++slot) {
    bool fits = !begins.empty() && slot - begins.back() < kCapacity;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double at = at_[axis][slot];
      low[axis] = std::min(low[axis], at);
      high[axis] = std::max(high[axis], at);
      fits = fits && high[axis] - low[axis] <= kLargest * reach_;
    }
    if (fits) continue;
    begins.push_back(slot);
    for (std::size_t axis = 0; axis < 3; ++axis) low[axis] = high[axis] = at_[axis][slot];
  }
  return begins;
}

bool Tiles::refresh(const PointsView& points) {
  gather(points);
  return set_tile_boxes();
}

bool Tiles::set_tile_boxes() {
  constexpr std::size_t kBlock = 1024;  // tiles
  Boxes& tiles = levels_.front();
  std::vector<char> compact(blocks_of(size(), kBlock), 1);
  for_blocks(size(), kBlock, [&](std::size_t block, std::size_t begin, std::size_t end) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      for (std::size_t t = begin; t < end; ++t) {
        double low = kInfinity;
        double high = -kInfinity;
        for (std::uint32_t slot = begin_[t]; slot < begin_[t + 1]; ++slot) {
          low = std::min(low, at_[axis][slot]);
          high = std::max(high, at_[axis][slot]);
        }
        tiles.low[axis][t] = low;
        tiles.high[axis][t] = high;
        if (high - low > 2.5 * reach_) compact[block] = 0;
      }
    }
  });
  for (std::size_t level = 1; level < levels_.size(); ++level) set_boxes(levels_[level - 1], levels_[level]);
  return std::ranges::all_of(compact, [](char all) { return all != 0; });
}

/// A query of near_below(): boxes of one level near a box, and where to list them.
struct Tiles::Query {
  const Boxes& boxes;
  std::size_t box;
  std::size_t level;
  std::vector<std::uint32_t>& near;
};

void Tiles::near_groups(std::size_t group, std::vector<std::uint32_t>& near) const {
  near.clear();
  near_below(levels_.size() - 1, 0, {levels_[1], group, 1, near});
}

void Tiles::near_tiles(const std::array<double, 3>& at, std::vector<std::uint32_t>& near) const {
  near.clear();
  if (order_.empty()) return;
  Boxes point(1);
  for (std::size_t axis = 0; axis < 3; ++axis) point.low[axis][0] = point.high[axis][0] = at[axis];
  near_below(levels_.size() - 1, 0, {point, 0, 0, near});
}

void Tiles::near_below(std::size_t level, std::size_t box, const Query& query) const {
  if (squared_gap(levels_[level], box, query.boxes, query.box) > reach_ * reach_) return;
  if (level == query.level) {
    query.near.push_back(static_cast<std::uint32_t>(box));
    return;
  }
  for (std::size_t child = box * kFanOut; child < (box + 1) * kFanOut; ++child) {
    near_below(level - 1, child, query);
  }
}

}  // namespace crisp::quality
