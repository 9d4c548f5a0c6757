// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/diagnose/scans/range_jump.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "pipeline/statistics/robust_estimators.hpp"

namespace crisp::diagnose {
namespace {

constexpr std::size_t kMinHits = 10;

/// [m] Change between scans i and i + 1 beyond half of the changes before and after.
std::optional<double> jump_behind(const std::vector<SeriesScan>& scans, std::size_t i) {
  std::vector<double> jumps;
  for (std::size_t k = 0; k < scans[i].ranges().size(); ++k) {
    std::array<double, 4> r{};
    for (std::size_t j = 0; j < r.size(); ++j) {
      const auto& ranges = scans[i + j - 1].ranges();
      r[j] = k < ranges.size() ? double{ranges[k]} : 0;
    }
    if (std::ranges::any_of(r, [](double range) { return !(range > 0); })) continue;
    jumps.push_back((r[2] - r[1]) - ((r[1] - r[0]) + (r[3] - r[2])) / 2);
  }
  if (jumps.size() < std::max<std::size_t>(kMinHits, scans[i].ranges().size() / 4)) return {};
  return statistics::median_in_place(jumps);
}

}  // namespace

std::optional<double> largest_jump(const std::vector<SeriesScan>& scans) {
  std::optional<double> largest;
  for (std::size_t i = 1; i + 2 < scans.size(); ++i) {
    if (const auto jump = jump_behind(scans, i)) largest = std::max(largest.value_or(0), std::abs(*jump));
  }
  return largest;
}

}  // namespace crisp::diagnose
