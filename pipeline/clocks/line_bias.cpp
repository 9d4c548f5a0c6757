// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/clocks/line_bias.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace crisp::clocks {
namespace {

/// About n · (x / lowest)^shape of the stamps have delays below x.
struct DelayDistribution {
  double lowest = 0;  ///< [s] below which one stamp is expected
  double shape = 1;   ///< 1 where delays are as likely down to the least one, more where they thin out

  /// [s^power] Mean power of the order-th smallest delay.
  double mean_power(double order, double power) const {
    return std::pow(lowest, power) * std::exp(std::lgamma(order + power / shape) - std::lgamma(order));
  }
};

/// A line of known slope lies on the smallest delay, one that two stamps hold between the smallest two.
constexpr double kOrder = 1.75;

std::vector<double> delays_above(std::span<const Stamp> stamps, const ClockLine& line) {
  std::vector<double> above;
  above.reserve(stamps.size());
  for (const Stamp& stamp : stamps) above.push_back(std::max(0.0, stamp.lead - line.lead(stamp.device)));
  std::ranges::sort(above);
  return above;
}

}  // namespace

LineBias estimate_line_bias(std::span<const Stamp> stamps, const ClockLine& line, double quantum) {
  constexpr double kUsualDelay = 1e-3;  // [s] assumed where there are too few stamps
  constexpr double kRoots = 2.5;        // of the stamps: few enough to be near the least one
  constexpr double kBeforehand = 2;     // stamps that speak for a shape of 1
  constexpr double kMaxOfFourth = 3;    // a few stamps may be faster than all others: the law is theirs then
  constexpr int kTurns = 60;
  if (stamps.size() < 4) return {.mean = 0, .std_error = kUsualDelay};
  const std::vector<double> above = delays_above(stamps, line);
  const auto n = static_cast<double>(above.size());
  const auto used = static_cast<std::size_t>(std::clamp(kRoots * std::sqrt(n), 2.0, n / 2));
  const auto m = static_cast<double>(used);
  const double end = above[used];
  if (end <= quantum) return {.mean = 0, .std_error = quantum};
  DelayDistribution law;
  double late = end / m;  // shape and line are found in turn, as delays are known from the line on only
  for (int turn = 0; turn < kTurns; ++turn) {
    double sum = 0;
    for (std::size_t i = 0; i < used; ++i) sum += std::log((end + late) / (above[i] + late));
    const double shape = std::clamp((m + kBeforehand) / (sum + kBeforehand), 0.3, 8.0);
    law.shape = (law.shape + shape) / 2;
    law.lowest = (end + late) * std::pow(m, -1 / law.shape);
    late = (late + std::min(end, law.mean_power(kOrder, 1))) / 2;
  }
  const double mean = law.mean_power(kOrder, 1);
  const double scatter = std::sqrt(std::max(0.0, law.mean_power(kOrder, 2) - mean * mean));
  const double of_shape = mean * std::log(m) / std::sqrt(m) * law.shape;
  const double most = std::max(quantum, kMaxOfFourth * above[3]);
  return {.mean = std::min(mean, most),
          .std_error = std::max({quantum, std::hypot(scatter, of_shape), mean - most})};
}

}  // namespace crisp::clocks
