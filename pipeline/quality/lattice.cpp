// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/quality/lattice.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "pipeline/quality/axes.hpp"
#include "pipeline/quality/blocks.hpp"

namespace crisp::quality {
namespace {

constexpr std::size_t kSlab = 8;  // planes; a point reaches 6, so only into the next slab

/// The first node and the number of nodes along one axis. Nodes lie at multiples of the step, so that they
/// stay where they are when points move.
std::pair<double, std::size_t> extent(std::span<const double> values, double step) {
  const auto [low, high] = std::ranges::minmax(values);
  const double first = std::floor(low / step) - 3;  // two that are reached, and one against rounding
  return {first * step, static_cast<std::size_t>(std::floor(high / step) - first) + 5};
}

/// Cardinal B-splines of one order more, from those of order q: N(q+1)(x) at x = t + k, k = 0 … q.
template <std::size_t kSize>
void raise(std::array<double, kSize>& b, std::size_t q, double t) {
  const auto order = static_cast<double>(q);
  for (std::size_t k = q + 1; k-- > 0;) {
    const double x = t + static_cast<double>(k);
    const double here = k < q ? b[k] : 0;
    const double before = k > 0 ? b[k - 1] : 0;
    b[k] = (x * here + (order + 1 - x) * before) / order;
  }
}

constexpr std::size_t kChunk = 2048;  // values that stay in the first cache

/// The values begin, begin + 1 … of a block convolved along its nodes, which are `stride` values apart.
void convolve_chunk(std::span<const double> block, std::size_t stride, std::span<const double> half,
                    std::size_t begin, std::span<double> result) {
  const std::size_t end = begin + result.size();
  for (std::size_t k = begin; k < end; ++k) result[k - begin] = half[0] * block[k];
  for (std::size_t m = 1; m < half.size(); ++m) {
    const std::size_t shift = m * stride;
    if (shift >= block.size()) break;
    const std::size_t last = std::min(end, block.size() - shift);
    for (std::size_t k = begin; k < last; ++k) result[k - begin] += half[m] * block[k + shift];
    for (std::size_t k = std::max(begin, shift); k < end; ++k)
      result[k - begin] += half[m] * block[k - shift];
  }
}

}  // namespace

double Lattice::nodes_about(const PointsView& points, double step) {
  double product = 1;
  for (const auto& axis : axes(points)) {
    const auto [low, high] = std::ranges::minmax(axis);
    product *= (high - low) / step + 9;
  }
  return product;
}

Lattice::Lattice(const PointsView& points, double step) : step_(step) {
  std::array<std::pair<std::size_t, std::size_t>, 3> by_length;
  std::array<double, 3> first{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto [origin, nodes] = extent(axes(points)[axis], step);
    first[axis] = origin;
    by_length[axis] = {nodes, axis};
  }
  std::ranges::sort(by_length);
  const std::array order{by_length[2], by_length[0], by_length[1]};
  for (std::size_t k = 0; k < 3; ++k) {
    axis_[k] = order[k].second;
    nodes_[k] = order[k].first;
    origin_[k] = first[axis_[k]];
  }
  field_.assign(nodes_[0] * nodes_[1] * nodes_[2], 0);
}

Lattice::Splines Lattice::splines(std::size_t axis, double coordinate) const {
  const double at = (coordinate - origin_[axis]) / step_;
  const double node = std::floor(at);
  const double t = at - node;
  std::array<double, kSupport> b{1};
  for (std::size_t q = 1; q < kSupport - 1; ++q) raise(b, q, t);
  Splines result;
  result.first = static_cast<std::size_t>(node) - 2;
  const auto lower = b;  // of order 5: what the slopes are differences of
  raise(b, kSupport - 1, t);
  for (std::size_t k = 0; k < kSupport; ++k) {
    // The k-th node from the point's left end meets the spline at t + 5 − k.
    const std::size_t j = kSupport - 1 - k;
    result.value[k] = b[j];
    result.slope[k] = ((j < kSupport - 1 ? lower[j] : 0) - (j > 0 ? lower[j - 1] : 0)) / step_;
  }
  return result;
}

void Lattice::spread(const PointsView& points, std::span<const double> weights) {
  // Slabs of even number in parallel, then the odd ones: no two write to the same nodes, and each in the
  // order of its points.
  const std::size_t slabs = nodes_[0] / kSlab + 1;
  std::vector<std::vector<std::uint32_t>> members(slabs);
  const auto longest = axes(points)[axis_[0]];
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto first = static_cast<std::size_t>((longest[i] - origin_[0]) / step_) - 2;
    members[first / kSlab].push_back(static_cast<std::uint32_t>(i));
  }
  for (const std::size_t parity : {0, 1}) {
    for_each_index((slabs + 1 - parity) / 2,
                   [&](std::size_t s) { spread_slab(points, weights, members[2 * s + parity]); });
  }
}

void Lattice::spread_slab(const PointsView& points, std::span<const double> weights,
                          std::span<const std::uint32_t> members) {
  const auto coordinates = axes(points);
  for (const std::uint32_t i : members) {
    const Splines slow = splines(0, coordinates[axis_[0]][i]);
    const Splines middle = splines(1, coordinates[axis_[1]][i]);
    const Splines fast = splines(2, coordinates[axis_[2]][i]);
    for (std::size_t a = 0; a < kSupport; ++a) {
      for (std::size_t b = 0; b < kSupport; ++b) {
        double* row = &field_[((slow.first + a) * nodes_[1] + middle.first + b) * nodes_[2] + fast.first];
        const double weight = weights[i] * slow.value[a] * middle.value[b];
        for (std::size_t c = 0; c < kSupport; ++c) row[c] += weight * fast.value[c];
      }
    }
  }
}

void Lattice::convolve(std::span<const double> half) {
  std::vector<double> result(field_.size());
  std::size_t block = field_.size();
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::size_t stride = block / nodes_[axis];
    const std::size_t chunks = (block + kChunk - 1) / kChunk;
    for_each_index(field_.size() / block * chunks, [&](std::size_t unit) {
      const std::size_t start = unit / chunks * block;
      const std::size_t begin = unit % chunks * kChunk;
      convolve_chunk({&field_[start], block}, stride, half, begin,
                     {&result[start + begin], std::min(kChunk, block - begin)});
    });
    field_.swap(result);
    block = stride;
  }
}

Lattice::Value Lattice::at(double x, double y, double z) const {
  const std::array<double, 3> point{x, y, z};
  const Splines slow = splines(0, point[axis_[0]]);
  const Splines middle = splines(1, point[axis_[1]]);
  const Splines fast = splines(2, point[axis_[2]]);
  double value = 0;
  std::array<double, 3> gradient{};
  for (std::size_t a = 0; a < kSupport; ++a) {
    for (std::size_t b = 0; b < kSupport; ++b) {
      const double* row = &field_[((slow.first + a) * nodes_[1] + middle.first + b) * nodes_[2] + fast.first];
      double sum = 0;
      double slope = 0;
      for (std::size_t c = 0; c < kSupport; ++c) {
        sum += row[c] * fast.value[c];
        slope += row[c] * fast.slope[c];
      }
      value += slow.value[a] * middle.value[b] * sum;
      gradient[0] += slow.slope[a] * middle.value[b] * sum;
      gradient[1] += slow.value[a] * middle.slope[b] * sum;
      gradient[2] += slow.value[a] * middle.value[b] * slope;
    }
  }
  Value result{value};
  for (std::size_t k = 0; k < 3; ++k) result.gradient[axis_[k]] = gradient[k];
  return result;
}

}  // namespace crisp::quality
