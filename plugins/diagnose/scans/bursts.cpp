// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/diagnose/scans/bursts.hpp"

#include <algorithm>
#include <cmath>

#include "pipeline/statistics/monte_carlo_test.hpp"
#include "pipeline/statistics/random_stream.hpp"

namespace crisp::diagnose {
namespace {

/// Share of times within a quarter interval after the previous one.
double share_together(std::vector<double> times, double interval) {
  constexpr double kTogether = 0.25;
  std::ranges::sort(times);
  double together = 0;
  for (std::size_t i = 1; i < times.size(); ++i) {
    if (times[i] - times[i - 1] < kTogether * interval) together += 1;
  }
  return together / static_cast<double>(times.size() - 1);
}

}  // namespace

Bursts find_bursts(const std::vector<double>& receipts, const std::vector<double>& stamps,
                   std::uint64_t seed) {
  Bursts bursts;
  constexpr std::size_t kMin = 10;
  if (receipts.size() < kMin) return bursts;
  const auto n = static_cast<double>(receipts.size());
  bursts.interval = (stamps.back() - stamps.front()) / (n - 1);
  bursts.together = share_together(receipts, bursts.interval);
  bursts.together_error = std::sqrt(bursts.together * (1 - bursts.together) / (n - 1));

  std::vector<double> delays;
  double mean = 0;
  for (std::size_t i = 0; i < receipts.size(); ++i) delays.push_back(receipts[i] - stamps[i]);
  for (const double delay : delays) mean += delay / n;
  for (const double delay : delays) bursts.wait += (delay - mean) * (delay - mean) / n;
  bursts.wait = std::sqrt(bursts.wait);
  const auto [least, most] = std::minmax_element(delays.begin(), delays.end());
  bursts.longest = *most - *least;

  constexpr std::size_t kShuffles = 999;
  statistics::RandomStream random(seed, "bursts");
  const auto permuted = [&] {
    random.shuffle(delays);
    std::vector<double> times;
    for (std::size_t k = 0; k < stamps.size(); ++k) times.push_back(stamps[k] + delays[k]);
    return share_together(std::move(times), bursts.interval);
  };
  bursts.p_value = statistics::monte_carlo_test(bursts.together, kShuffles, permuted).p_value;
  return bursts;
}

}  // namespace crisp::diagnose
