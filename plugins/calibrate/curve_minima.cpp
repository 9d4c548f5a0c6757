// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/calibrate/curve_minima.hpp"

#include <algorithm>
#include <boost/math/tools/minima.hpp>
#include <cmath>
#include <cstdint>

namespace crisp::calibrate {

std::vector<double> local_minima(const Curve& curve, const std::vector<double>& grid, bool circular) {
  std::vector<double> cost;
  for (const double place : grid) cost.push_back(curve(place));
  std::vector<std::size_t> found;
  const std::size_t n = grid.size();
  for (std::size_t i = 0; i < n; ++i) {
    const bool below_left = i > 0 ? cost[i] <= cost[i - 1] : !circular || cost[i] <= cost[n - 1];
    const bool below_right = i + 1 < n ? cost[i] < cost[i + 1] : !circular || cost[i] < cost[0];
    if (below_left && below_right) found.push_back(i);
  }
  std::ranges::sort(found, [&](auto a, auto b) { return cost[a] < cost[b]; });
  std::vector<double> places;
  for (const auto i : found) places.push_back(grid[i]);
  return places;
}

LineMinimum bottom(const Curve& curve, const LineSearch& search) {
  const auto [start, step, lower, upper, accuracy] = search;
  const int bits = static_cast<int>(std::ceil(1 - std::log2(accuracy)));
  constexpr double kAtTheEnd = 0.95;  // of the step: the curve may fall on beyond
  constexpr int kMaxSteps = 50;
  LineMinimum best{.at = start, .value = 0};
  for (int k = 0; k < kMaxSteps; ++k) {
    const double middle = best.at;
    const double from = std::max(-1.0, (lower - middle) / step);
    const double to = std::min(1.0, (upper - middle) / step);
    std::uintmax_t evaluations = 40;
    const auto [y, value] = boost::math::tools::brent_find_minima(
        [&, by = step](double at) { return curve(middle + by * at); }, from, to, bits, evaluations);
    best = {.at = middle + step * y, .value = value};
    const bool is_at_border = best.at <= lower + 0.05 * step || best.at >= upper - 0.05 * step;
    if (std::abs(y) < kAtTheEnd || is_at_border) break;
  }
  return best;
}

}  // namespace crisp::calibrate
