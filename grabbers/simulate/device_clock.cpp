// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/simulate/device_clock.hpp"

#include <algorithm>
#include <cmath>

namespace crisp::simulate {

std::size_t DeviceClock::resets_before(double hub_time) const {
  return static_cast<std::size_t>(std::upper_bound(resets.begin(), resets.end(), hub_time) - resets.begin());
}

double DeviceClock::seconds(double hub_time) const {
  const auto run = [&](double t) { return t / (1 + skew) - drift * t * t / 2 + step.before(t); };
  const std::size_t past = resets_before(hub_time);
  return past == 0 ? start + run(hub_time) : run(hub_time) - run(resets[past - 1]);
}

std::uint32_t DeviceClock::microseconds(double hub_time) const {
  // A counter shows whole steps that have passed; a stamp before the counter's start wraps like the counter.
  return static_cast<std::uint32_t>(static_cast<std::int64_t>(std::floor(1e6 * seconds(hub_time))));
}

}  // namespace crisp::simulate
