// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <random>
#include <vector>

#include "pipeline/clocks/clock_line.hpp"

namespace crisp::test {

using Random = std::mt19937_64;

/// A law of delays [s] beyond the smallest one; called once a stamp, in order of time.
using Delays = std::function<double(Random&)>;

inline Delays exponential_delays(double mean) {
  return [=](Random& random) { return std::exponential_distribution<>(1 / mean)(random); };
}

/// The fewer the nearer to the smallest delay, the larger the shape.
inline Delays gamma_delays(double shape, double scale) {
  return [=](Random& random) { return std::gamma_distribution<>(shape, scale)(random); };
}

/// Exponential delays, and now and then a stretch of stamps that are all late by much more.
inline Delays bursty_delays(double mean, double burst, int length, double chance) {
  return [=, left = 0](Random& random) mutable {
    if (std::uniform_real_distribution<>(0, 1)(random) < chance) left = length;
    const double late = left-- > 0 ? burst : 0;
    return late + std::exponential_distribution<>(1 / mean)(random);
  };
}

/// Stamps of a clock with this skew at a rate [Hz] for a duration [s], with delays, to the microsecond.
inline std::vector<clocks::Stamp> simulated_stamps(std::uint64_t seed, double duration, double rate,
                                                   double skew, const Delays& delays) {
  Random random(seed);
  std::vector<clocks::Stamp> stamps;
  for (double t = 0; t < duration; t += 1 / rate) {
    const double device = std::floor(1e6 * t) * 1e-6;
    const double hub = std::floor(1e6 * (t * (1 + skew) + delays(random))) * 1e-6;
    stamps.push_back({.device = device, .lead = hub - device});
  }
  return stamps;
}

inline double mean_device_time(const std::vector<clocks::Stamp>& stamps) {
  double sum = 0;
  for (const auto& stamp : stamps) sum += stamp.device;
  return sum / static_cast<double>(stamps.size());
}

}  // namespace crisp::test
