// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/diagnose/clocks/device_jumps.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "pipeline/statistics/robust_estimators.hpp"

namespace crisp::diagnose {
namespace {

constexpr std::size_t kAround = 20;  // stamps before and after

/// Visits each pair of stamps near `at` that are a given number apart and not across it.
template <class Take>
void for_each_pair(std::span<const CountedStamp> stamps, std::size_t at, std::size_t apart, Take take) {
  const std::size_t begin = at > kAround ? at - kAround : 0;
  for (std::size_t i = begin; i + apart < std::min(stamps.size(), at + kAround); ++i) {
    if (i < at && i + apart >= at) continue;
    const auto counts = static_cast<double>(stamps[i + apart].count - stamps[i].count);
    if (counts > 0) take(stamps[i + apart].stamp.device - stamps[i].stamp.device, counts);
  }
}

/// [s] Device time per count near a stamp; 0 without stamps.
double local_period(std::span<const CountedStamp> stamps, std::size_t at) {
  constexpr std::size_t kApart = 4;  // stamps, which reduces the effect of a late telegram
  std::vector<double> periods;
  for_each_pair(stamps, at, kApart, [&](double time, double counts) { periods.push_back(time / counts); });
  return periods.empty() ? 0 : statistics::median_in_place(periods);
}

/// [s] Standard deviation of the intervals between stamps about their counts times the period.
double local_scatter(std::span<const CountedStamp> stamps, std::size_t at) {
  const double period = local_period(stamps, at);
  std::vector<double> sizes;
  for_each_pair(stamps, at, 1,
                [&](double time, double counts) { sizes.push_back(std::abs(time - period * counts)); });
  return sizes.empty()
             ? kStampQuantum
             : std::max(kStampQuantum, statistics::kMadToSigma * statistics::median_in_place(sizes));
}

}  // namespace

double device_jump(std::span<const CountedStamp> stamps, std::size_t at) {
  constexpr std::size_t kLasting = 5;  // stamps before and after
  const double period = local_period(stamps, at);
  if (period == 0) return 0;
  std::vector<double> jumps;
  for (std::size_t k = 0; k < kLasting && k < at && at + k < stamps.size(); ++k) {
    const CountedStamp& from = stamps[at - 1 - k];
    const CountedStamp& to = stamps[at + k];
    const auto counts = static_cast<double>(std::max<std::int64_t>(1, to.count - from.count));
    jumps.push_back(to.stamp.device - from.stamp.device - period * counts);
  }
  const double here = jumps.front();
  const double lasting = statistics::median_in_place(jumps);
  if (here * lasting <= 0) return 0;
  return std::abs(here) < std::abs(lasting) ? here : lasting;
}

std::size_t largest_device_jump(std::span<const CountedStamp> stamps, std::size_t begin, std::size_t end) {
  std::size_t best = std::max<std::size_t>(1, begin);
  for (std::size_t i = best; i < end; ++i) {
    if (std::abs(device_jump(stamps, i)) > std::abs(device_jump(stamps, best))) best = i;
  }
  return best;
}

double log10_odds_of_jump(std::span<const CountedStamp> stamps, std::size_t at, double by) {
  constexpr double kDegreesOfFreedom = 3;
  const double width = local_scatter(stamps, at);
  const auto log_density = [&](double off) {
    return -(kDegreesOfFreedom + 1) / 2 * std::log1p(std::pow(off / width, 2) / kDegreesOfFreedom);
  };
  const double jump = device_jump(stamps, at);
  return (log_density(jump - by) - log_density(jump)) / std::numbers::ln10;
}

}  // namespace crisp::diagnose
