// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include <crisp/error.hpp>
#include <crisp/points.hpp>

#include "pipeline/quality/blocks.hpp"

namespace crisp {
namespace {

bool is_a_position(double value) { return std::abs(value) <= 1e12; }

bool are_positions(std::span<const double> values) {
  constexpr std::size_t kBlock = 65536;  // values
  std::vector<char> good(quality::blocks_of(values.size(), kBlock));
  quality::for_blocks(values.size(), kBlock, [&](std::size_t block, std::size_t begin, std::size_t end) {
    bool all = true;  // without a branch: by vectors
    for (std::size_t i = begin; i < end; ++i) all &= is_a_position(values[i]);
    good[block] = all ? 1 : 0;
  });
  return std::ranges::all_of(good, [](char block) { return block != 0; });
}

}  // namespace

void Vectors::assign(std::size_t n, double value) {
  const std::array<std::vector<double>*, 3> axes{&x, &y, &z};
  quality::for_each_array(axes.size(), n, [&](std::size_t axis) { axes[axis]->assign(n, value); });
}

void check(const PointsView& points) {
  const std::size_t n = points.size();
  if (points.y.size() != n || points.z.size() != n) {
    throw Error(
        fmt::format("the points have {} x, {} y and {} z coordinates", n, points.y.size(), points.z.size()),
        "give as many of each");
  }
  for (const auto& axis : {points.x, points.y, points.z}) {
    if (are_positions(axis)) continue;
    const auto bad = std::ranges::find_if_not(axis, is_a_position);
    throw Error(fmt::format("point {} has a coordinate of {} m", bad - axis.begin(), *bad),
                "remove points without a valid position");
  }
}

void check_weights(std::span<const double> weights, std::size_t n) {
  if (weights.empty()) return;
  if (weights.size() != n) {
    throw Error(fmt::format("there are {} weights for {} points", weights.size(), n),
                "give one a point, or none at all");
  }
  const auto bad = std::ranges::find_if(weights, [](double w) { return !(std::isfinite(w) && w >= 0); });
  if (bad != weights.end()) {
    throw Error(fmt::format("the weight of point {} is {}", bad - weights.begin(), *bad),
                "weights are finite and not negative");
  }
  if (std::ranges::none_of(weights, [](double w) { return w > 0; })) {
    throw Error("all weights are 0", "give at least one point a weight above 0");
  }
}

std::vector<double> with_mean_one(std::span<const double> weights, std::size_t n) {
  if (weights.empty()) return std::vector<double>(n, 1);
  std::vector<double> scaled(weights.begin(), weights.end());
  // Against the largest first, so that a sum of huge weights does not overflow.
  const double largest = *std::ranges::max_element(scaled);
  for (double& w : scaled) w /= largest;
  const double mean = std::accumulate(scaled.begin(), scaled.end(), 0.0) / static_cast<double>(n);
  for (double& w : scaled) w /= mean;
  return scaled;
}

}  // namespace crisp
