// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/clocks/hub_forward_step.hpp"

#include <algorithm>
#include <cmath>

#include "pipeline/data/recordings.hpp"

namespace crisp::clocks {
namespace {

constexpr double kTolerance = 0.1;            // [s] of delays, and among devices
constexpr double kShortest = 0.5;             // [s] after the gap, to see whether a clock runs
constexpr double kSmallestForwardStep = 1;    // [s]
constexpr double kClockPeriod = 4294.967296;  // [s] of a device's clock
constexpr double kMaxSkewOfPause = 1e-3;      // of a device's clock in a pause of whole wraps

double hub_between(const DeviceStamp& from, const DeviceStamp& to) {
  return 1e-9 * static_cast<double>(to.receipt_ns - from.receipt_ns);
}

double device_between(const DeviceStamp& from, const DeviceStamp& to) {
  return 1e-6 * static_cast<double>(to.device_us - from.device_us);  // across a wrap, too
}

/// Whether a gap of whole wraps of the devices' clocks may be a pause as well.
bool may_be_pause(double step) {
  const double wraps = std::round(step / kClockPeriod);
  return wraps >= 1 &&
         std::abs(step - wraps * kClockPeriod) < kMaxSkewOfPause * wraps * kClockPeriod + kTolerance;
}

}  // namespace

void ForwardStep::after(std::size_t device, const DeviceStamp& stamp) {
  after_.try_emplace(device, After{.first = stamp, .last = stamp}).first->second.last = stamp;
}

std::optional<std::int64_t> ForwardStep::size_ns() const {
  std::vector<double> steps;
  for (const auto& [device, seen] : after_) {
    const auto before = before_.find(device);
    const double hub = hub_between(seen.first, seen.last);
    if (before == before_.end() || hub < kShortest) continue;
    const double ran_on = device_between(before->second, seen.first);
    const bool is_even = std::abs(device_between(seen.first, seen.last) - hub) < kTolerance;
    if (!is_even || data::is_pause(ran_on)) return std::nullopt;
    steps.push_back(hub_between(before->second, seen.first) - ran_on);
  }
  if (steps.size() < 2) return std::nullopt;
  std::ranges::sort(steps);
  const double step = steps[steps.size() / 2];
  if (steps.back() - steps.front() > kTolerance || step < kSmallestForwardStep || may_be_pause(step))
    return std::nullopt;
  return std::llround(1e9 * step);
}

}  // namespace crisp::clocks
