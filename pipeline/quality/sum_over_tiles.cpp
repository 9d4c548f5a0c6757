// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/quality/sum_over_tiles.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "pipeline/quality/blocks.hpp"
#include "pipeline/quality/tile_sums.hpp"

namespace crisp::quality {
namespace {

/// Positions and weights in the order of the tiles, in single precision and kernel units.
struct Slots {
  std::array<std::vector<float>, 3> offset;
  std::vector<float> weight;
};

Slots fill_slots(const Tiles& tiles, std::span<const double> weights, double scale) {
  const std::size_t padded = tiles.points() + simd::kPadding;
  Slots slots;
  const std::array<std::vector<float>*, 4> all{slots.offset.data(), &slots.offset[1], &slots.offset[2],
                                               &slots.weight};
  for_each_array(all.size(), padded, [&](std::size_t i) { all[i]->resize(padded); });
  for_blocks(tiles.size(), 1024, [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t) {
      for (std::uint32_t slot = tiles.begin()[t]; slot < tiles.begin()[t + 1]; ++slot) {
        slots.weight[slot] = static_cast<float>(weights[tiles.order()[slot]]);
        for (std::size_t axis = 0; axis < 3; ++axis) {
          const double middle = 0.5 * (tiles.boxes().low[axis][t] + tiles.boxes().high[axis][t]);
          slots.offset[axis][slot] = static_cast<float>(scale * (tiles.at(axis)[slot] - middle));
        }
      }
    }
  });
  return slots;
}

simd::TileArrays arrays(const Tiles& tiles, const Slots& slots) {
  simd::TileArrays result{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    result.offset[axis] = slots.offset[axis].data();
    result.low[axis] = tiles.boxes().low[axis].data();
    result.high[axis] = tiles.boxes().high[axis].data();
  }
  result.weight = slots.weight.data();
  result.begin = tiles.begin().data();
  result.size = tiles.size();
  return result;
}

/// Groups of tiles to a task: depends on the data alone, so that the sums do not depend on the threads.
std::size_t groups_a_task(const Tiles& tiles) { return std::clamp<std::size_t>(tiles.groups() / 64, 8, 128); }

/// Sums one task; its block_scores go to where its points are in the cloud.
simd::TaskSums sum_task(const Tiles& tiles, const simd::TileArrays& data, const simd::PairKernel& kernel,
                        std::size_t first_group, std::size_t last_group, Vectors& gradient) {
  simd::TaskSums sums{};
  sums.first_tile = first_group * Tiles::kFanOut;
  sums.last_tile = std::min(tiles.size(), last_group * Tiles::kFanOut);
  const std::uint32_t first_slot = tiles.begin()[sums.first_tile];
  const std::size_t slots = tiles.begin()[sums.last_tile] - first_slot;
  std::array<std::vector<float>, 3> slot_gradient;
  for (std::size_t axis = 0; axis < 3 && gradient.size() != 0; ++axis) {
    slot_gradient[axis].resize(slots);
    sums.gradient[axis] = slot_gradient[axis].data();
  }
  std::vector<std::uint32_t> near;
  for (std::size_t group = first_group; group < last_group; ++group) {
    tiles.near_groups(group, near);
    simd::add_group(data, kernel, group, near.data(), near.size(), sums);
  }
  const std::array<std::vector<double>*, 3> out{&gradient.x, &gradient.y, &gradient.z};
  for (std::size_t axis = 0; axis < 3 && gradient.size() != 0; ++axis) {
    for (std::size_t s = 0; s < slots; ++s) {
      const double weight = data.weight[first_slot + s];
      (*out[axis])[tiles.order()[first_slot + s]] = weight * slot_gradient[axis][s] / kernel.scale;
    }
  }
  return sums;
}

}  // namespace

GaussianSums sum_over_tiles(const Tiles& tiles, const PointsView& points, std::span<const double> weights,
                            const TruncatedGaussian& kernel, bool gradient) {
  const double scale = std::sqrt(kernel.exponent * std::numbers::log2e);
  const simd::PairKernel pair{kernel.radius, scale, static_cast<float>(kernel.floor)};
  const Slots slots = fill_slots(tiles, weights, scale);
  const simd::TileArrays data = arrays(tiles, slots);
  GaussianSums result;
  if (gradient) result.gradient.assign(points.size(), 0);
  const std::size_t step = groups_a_task(tiles);
  std::vector<simd::TaskSums> tasks(blocks_of(tiles.groups(), step));
  for_blocks(tiles.groups(), step, [&](std::size_t t, std::size_t first, std::size_t last) {
    tasks[t] = sum_task(tiles, data, pair, first, last, result.gradient);
  });
  std::uint64_t ordered_pairs = 0;
  for (const simd::TaskSums& task : tasks) {
    result.kernel += task.kernel;
    ordered_pairs += task.pairs;
    result.tested += task.tested;
  }
  result.pairs = (ordered_pairs - points.size()) / 2;  // each point met itself
  return result;
}

}  // namespace crisp::quality
