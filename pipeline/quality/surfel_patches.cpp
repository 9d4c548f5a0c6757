// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/quality/surfel_patches.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <numeric>

#include "pipeline/quality/blocks.hpp"
#include "pipeline/quality/view_flatness.hpp"

namespace crisp::quality {
namespace {

constexpr double kThicknessToWidth = 0.1;

/// Finds flat cells from large to small.
class PatchFinder {
 public:
  PatchFinder(const BeamsView& beams, const ViewNumbers& views, const SurfelCells& cells,
              const SurfelSettings& settings)
      : cells_(cells), settings_(settings), shape_(beams, views, settings) {}

  /// @param level  a cell here is 2^level of the smallest wide
  void find(std::size_t first, std::size_t last, int level) {
    FlatPatch patch{first, last, {}, {}};
    for (std::size_t c = first; c < last; ++c) patch.moments += cells_.moments[c];
    if (patch.moments.count < settings_.min_points) return;
    patch.plane = plane_of(patch.moments);
    if (is_flat(patch)) {
      found_.push_back(std::move(patch));
      return;
    }
    if (level == 0) return;
    const int shift = 3 * (level - 1);
    for (std::size_t begin = first; begin < last;) {
      std::size_t end = begin + 1;
      while (end < last && cells_.key[end] >> shift == cells_.key[begin] >> shift) ++end;
      find(begin, end, level - 1);
      begin = end;
    }
  }

  std::vector<FlatPatch> take() { return std::move(found_); }

 private:
  bool is_flat(const FlatPatch& patch) {
    const auto& extent = patch.plane.extent;  // across the plane, and along it
    if (extent[0] > settings_.max_thickness || extent[1] < 4 * std::max(extent[0], settings_.noise)) {
      return false;
    }
    // Views that disagree thicken a surface by what their offset or tilt is; what is thick for its width is
    // more likely an edge, of which each view sees another side.
    const double beyond_noise = extent[0] * extent[0] - settings_.noise * settings_.noise;
    if (beyond_noise > kThicknessToWidth * kThicknessToWidth * extent[1] * extent[1]) return false;
    const std::span<const std::uint32_t> members(cells_.order.index.begin() + cells_.begin[patch.first_cell],
                                                 cells_.order.index.begin() + cells_.begin[patch.last_cell]);
    return shape_.is_flat(members, patch.plane, cells_.origin);
  }

  const SurfelCells& cells_;
  const SurfelSettings& settings_;
  ViewFlatness shape_;
  std::vector<FlatPatch> found_;
};

}  // namespace

SurfelCells cells_of(const BeamsView& beams, const SurfelSettings& settings) {
  SurfelCells cells;
  cells.order = spatial_order(beams.points, settings.smallest);
  const auto& order = cells.order;
  if (order.index.empty()) return cells;
  const std::uint32_t middle = order.index[order.index.size() / 2];
  cells.origin = cells.point(beams, middle);
  for (std::uint32_t k = 0; k < order.index.size(); ++k) {
    if (k == 0 || order.cell[k] != order.cell[k - 1]) {
      cells.key.push_back(order.cell[k]);
      cells.begin.push_back(k);
    }
  }
  cells.begin.push_back(static_cast<std::uint32_t>(order.index.size()));
  cells.moments.resize(cells.size());
  for_each_index(cells.size(), [&](std::size_t c) {
    Moments moments;
    for (std::uint32_t k = cells.begin[c]; k < cells.begin[c + 1]; ++k) {
      moments.add(cells.point(beams, order.index[k]));
    }
    cells.moments[c] = moments;
  });
  return cells;
}

std::vector<FlatPatch> flat_patches(const BeamsView& beams, const SurfelCells& cells,
                                    const SurfelSettings& settings) {
  const int levels = static_cast<int>(std::lround(std::log2(settings.largest / settings.smallest)));
  std::vector<std::size_t> first;  // of the cells of each largest one
  for (std::size_t c = 0; c < cells.size(); ++c) {
    if (c == 0 || cells.key[c] >> (3 * levels) != cells.key[c - 1] >> (3 * levels)) first.push_back(c);
  }
  const ViewNumbers views(beams);
  std::vector<std::vector<FlatPatch>> found(first.size());
  for_each_index(first.size(), [&](std::size_t k) {
    PatchFinder finder(beams, views, cells, settings);
    finder.find(first[k], k + 1 < first.size() ? first[k + 1] : cells.size(), levels);
    found[k] = finder.take();
  });
  std::vector<FlatPatch> all;
  for (auto& some : found) std::ranges::move(some, std::back_inserter(all));
  return all;
}

CellFinder::CellFinder(const SurfelCells& cells) : cells_(cells) {}

std::size_t CellFinder::find(std::uint64_t key) const {
  const auto at = std::ranges::lower_bound(cells_.key, key);
  return at != cells_.key.end() && *at == key ? static_cast<std::size_t>(at - cells_.key.begin())
                                              : cells_.size();
}

std::vector<std::size_t> CellFinder::around(std::size_t cell) const {
  std::vector<std::size_t> result;
  const auto middle = cell_of(cells_.key[cell]);
  for (std::int64_t dz = -1; dz <= 1; ++dz) {
    for (std::int64_t dy = -1; dy <= 1; ++dy) {
      for (std::int64_t dx = -1; dx <= 1; ++dx) {
        const std::size_t other = find(cell_key({middle[0] + dx, middle[1] + dy, middle[2] + dz}));
        if (other != cells_.size()) result.push_back(other);
      }
    }
  }
  return result;
}

}  // namespace crisp::quality
