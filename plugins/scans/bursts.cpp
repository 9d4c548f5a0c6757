// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/scans/bursts.hpp"

#include <algorithm>
#include <cmath>
#include <random>

namespace crisp {
namespace {

/// Of each value with the next, about their mean.
double next_correlation(const std::vector<double>& values) {
  double mean = 0;
  for (const double value : values) mean += value / static_cast<double>(values.size());
  double products = 0;
  double squares = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    squares += (values[i] - mean) * (values[i] - mean);
    if (i > 0) products += (values[i] - mean) * (values[i - 1] - mean);
  }
  return squares > 0 ? products / squares : 0;
}

std::vector<double> intervals(const std::vector<double>& times) {
  std::vector<double> all;
  for (std::size_t i = 1; i < times.size(); ++i) all.push_back(times[i] - times[i - 1]);
  return all;
}

}  // namespace

Bursts find_bursts(const std::vector<double>& receipts, const std::vector<double>& stamps,
                   std::uint64_t seed) {
  Bursts bursts;
  constexpr std::size_t kFewest = 10;
  if (receipts.size() < kFewest) return bursts;
  const auto n = static_cast<double>(receipts.size());
  bursts.interval = (stamps.back() - stamps.front()) / (n - 1);
  const auto between = intervals(receipts);
  constexpr double kTogether = 0.25;
  const auto together = std::count_if(between.begin(), between.end(),
                                      [&](double gap) { return gap < kTogether * bursts.interval; });
  bursts.together = static_cast<double>(together) / (n - 1);
  bursts.together_error = std::sqrt(bursts.together * (1 - bursts.together) / (n - 1));

  std::vector<double> delays;
  double mean = 0;
  for (std::size_t i = 0; i < receipts.size(); ++i) delays.push_back(receipts[i] - stamps[i]);
  for (const double delay : delays) mean += delay / n;
  for (const double delay : delays) bursts.wait += (delay - mean) * (delay - mean) / n;
  bursts.wait = std::sqrt(bursts.wait);
  const auto [least, most] = std::minmax_element(delays.begin(), delays.end());
  bursts.longest = *most - *least;

  // Single stalls of half a second must not hide what all others do: gaps count up to three intervals.
  const auto correlation = [&](const std::vector<double>& times) {
    constexpr double kStall = 3;
    auto gaps = intervals(times);
    for (double& gap : gaps) gap = std::clamp(gap, -kStall * bursts.interval, kStall * bursts.interval);
    return next_correlation(gaps);
  };
  bursts.correlation = correlation(receipts);
  constexpr int kShuffles = 999;
  std::mt19937_64 random(seed);
  int as_much = 0;
  for (int i = 0; i < kShuffles; ++i) {
    std::shuffle(delays.begin(), delays.end(), random);
    std::vector<double> times;
    for (std::size_t k = 0; k < stamps.size(); ++k) times.push_back(stamps[k] + delays[k]);
    if (correlation(times) <= bursts.correlation) ++as_much;
  }
  bursts.p_value = (as_much + 1.0) / (kShuffles + 1.0);
  return bursts;
}

}  // namespace crisp
