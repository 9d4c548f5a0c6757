// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/quality/rqe.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <vector>

#include "pipeline/data/error.hpp"
#include "pipeline/quality/kernel.hpp"

namespace crisp {
namespace {

constexpr std::int64_t kBits = 21;
constexpr std::int64_t kLast = (std::int64_t{1} << kBits) - 2;  // one to spare on either side

/// Points sorted into cubic cells; a row of cells along x is contiguous.
struct Cells {
  std::vector<double> x, y, z, w;
  std::vector<std::size_t> origin;  ///< where each sorted point came from
  std::vector<std::uint64_t> key;   ///< of each occupied cell, ascending
  std::vector<std::size_t> begin;   ///< its first point; one more than cells

  std::size_t size() const { return key.size(); }
};

std::uint64_t axis_cell(double value, double low, double side) {
  // Clamping keeps neighbours neighbours: what lies beyond shares the last cell.
  return static_cast<std::uint64_t>(std::clamp((value - low) / side + 1, 1.0, static_cast<double>(kLast)));
}

Cells sorted_into_cells(const PointsView& points, std::span<const double> weights, double side) {
  const std::size_t n = points.size();
  const double low_x = *std::ranges::min_element(points.x);
  const double low_y = *std::ranges::min_element(points.y);
  const double low_z = *std::ranges::min_element(points.z);
  std::vector<std::pair<std::uint64_t, std::size_t>> order(n);
  for (std::size_t i = 0; i < n; ++i) {
    order[i] = {axis_cell(points.z[i], low_z, side) << (2 * kBits) |
                    axis_cell(points.y[i], low_y, side) << kBits | axis_cell(points.x[i], low_x, side),
                i};
  }
  std::ranges::sort(order);
  Cells cells;
  for (auto* array : {&cells.x, &cells.y, &cells.z, &cells.w}) array->reserve(n);
  cells.origin.reserve(n);
  const double mean_weight =
      weights.empty() ? 1 : std::accumulate(weights.begin(), weights.end(), 0.0) / static_cast<double>(n);
  for (const auto& [key, i] : order) {
    if (cells.key.empty() || cells.key.back() != key) {
      cells.key.push_back(key);
      cells.begin.push_back(cells.origin.size());
    }
    cells.x.push_back(points.x[i] - low_x);
    cells.y.push_back(points.y[i] - low_y);
    cells.z.push_back(points.z[i] - low_z);
    cells.w.push_back(weights.empty() ? 1 : weights[i] / mean_weight);
    cells.origin.push_back(i);
  }
  cells.begin.push_back(n);
  return cells;
}

/// The points in the 3 × 3 × 3 cells about one, as up to nine contiguous ranges.
struct Surroundings {
  std::array<std::pair<std::size_t, std::size_t>, 9> ranges;
};

Surroundings surroundings(const Cells& cells, std::size_t cell) {
  Surroundings result;
  std::size_t row = 0;
  for (std::int64_t dz = -1; dz <= 1; ++dz) {
    for (std::int64_t dy = -1; dy <= 1; ++dy) {
      const std::uint64_t middle = cells.key[cell] +
                                   static_cast<std::uint64_t>(dz * (std::int64_t{1} << (2 * kBits))) +
                                   static_cast<std::uint64_t>(dy * (std::int64_t{1} << kBits));
      const auto first = std::ranges::lower_bound(cells.key, middle - 1) - cells.key.begin();
      const auto last = std::ranges::upper_bound(cells.key, middle + 1) - cells.key.begin();
      result.ranges.at(row++) = {cells.begin[first], cells.begin[last]};
    }
  }
  return result;
}

struct Sums {
  double kernel = 0;  ///< Σ wᵢ wⱼ K / G(0)
  std::uint64_t pairs = 0;
  std::uint64_t tested = 0;
};

/// Adds what all points around do to point i. Its derivative part is Σ wⱼ G (xᵢ − xⱼ) / G(0).
void add_point(const Cells& cells, std::size_t i, const Surroundings& around, const TruncatedGaussian& kernel,
               Sums& sums, Vectors& pull) {
  const double x = cells.x[i];
  const double y = cells.y[i];
  const double z = cells.z[i];
  const double radius2 = kernel.radius * kernel.radius;
  double sum = 0;
  double pull_x = 0;
  double pull_y = 0;
  double pull_z = 0;
  for (const auto& [begin, end] : around.ranges) {
    sums.tested += end - begin;
    for (std::size_t j = begin; j < end; ++j) {
      const double dx = x - cells.x[j];
      const double dy = y - cells.y[j];
      const double dz = z - cells.z[j];
      const double distance2 = dx * dx + dy * dy + dz * dz;
      if (distance2 >= radius2) continue;
      const double g = std::exp(-kernel.exponent * distance2);
      sum += cells.w[j] * (g - kernel.floor);
      pull_x += cells.w[j] * g * dx;
      pull_y += cells.w[j] * g * dy;
      pull_z += cells.w[j] * g * dz;
      ++sums.pairs;
    }
  }
  sums.kernel += cells.w[i] * sum;
  const std::size_t to = cells.origin[i];
  if (pull.size() == 0) return;
  pull.x[to] = cells.w[i] * pull_x;
  pull.y[to] = cells.w[i] * pull_y;
  pull.z[to] = cells.w[i] * pull_z;
}

Sums sum_over_pairs(const Cells& cells, const TruncatedGaussian& kernel, Vectors& pull) {
  constexpr std::size_t kCellsABlock = 128;
  std::vector<Sums> blocks((cells.size() + kCellsABlock - 1) / kCellsABlock);
  tbb::parallel_for(std::size_t{0}, blocks.size(), [&](std::size_t b) {
    const std::size_t end = std::min(cells.size(), (b + 1) * kCellsABlock);
    for (std::size_t cell = b * kCellsABlock; cell < end; ++cell) {
      const Surroundings around = surroundings(cells, cell);
      for (std::size_t i = cells.begin[cell]; i < cells.begin[cell + 1]; ++i) {
        add_point(cells, i, around, kernel, blocks[b], pull);
      }
    }
  });
  Sums total;
  for (const Sums& block : blocks) {
    total.kernel += block.kernel;
    total.pairs += block.pairs;
    total.tested += block.tested;
  }
  return total;
}

double sum_of_squared_cell_weights(const Cells& cells) {
  double sum = 0;
  for (std::size_t c = 0; c < cells.size(); ++c) {
    const double w =
        std::accumulate(cells.w.begin() + cells.begin[c], cells.w.begin() + cells.begin[c + 1], 0.0);
    sum += w * w;
  }
  return sum;
}

}  // namespace

Rqe rqe(const PointsView& points, std::span<const double> weights, const RqeSettings& settings) {
  check(points);
  check_weights(weights, points.size());
  if (points.size() == 0) throw Error("the entropy of a cloud without points is not defined");
  const TruncatedGaussian kernel(settings.sigma, settings.cutoff);
  const Cells cells = sorted_into_cells(points, weights, kernel.radius);

  Rqe result;
  if (settings.gradient) result.gradient.assign(points.size(), 0);
  const Sums sums = sum_over_pairs(cells, kernel, result.gradient);
  const double weight = std::accumulate(cells.w.begin(), cells.w.end(), 0.0);
  result.energy = kernel.peak * sums.kernel / (weight * weight);
  result.value = -std::log(result.energy);
  result.error_bound =
      std::log1p(truncation_bound(kernel, sum_of_squared_cell_weights(cells), kernel.radius) / sums.kernel);
  result.pairs = (sums.pairs - points.size()) / 2;  // each was met from either end, and each point met itself
  result.tested = sums.tested;
  // ∂H/∂xᵢ = −(∂E/∂xᵢ)/E, and both orders of a pair depend on xᵢ: twice the derivative of the exponent.
  const double scale = 4 * kernel.exponent / sums.kernel;
  for (auto* axis : {&result.gradient.x, &result.gradient.y, &result.gradient.z}) {
    for (double& g : *axis) g *= scale;
  }
  return result;
}

}  // namespace crisp
