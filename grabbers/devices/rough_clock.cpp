// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/devices/rough_clock.hpp"

#include <cmath>

namespace crisp::devices {

void RoughClock::begin(const clocks::DeviceStamp& stamp) {
  begun_ = true;
  last_ = stamp;
  first_ns_ = stamp.receipt_ns;
  elapsed_us_ = 0;
  width_ = 1;
  lowest_.assign(1, {});
}

bool RoughClock::take(const clocks::DeviceStamp& stamp) {
  if (!begun_) {
    begin(stamp);
    return false;
  }
  constexpr double kBack = 0.5, kAhead = 60;  // [s]
  const auto [hub_s, device_us] = clocks::elapsed(last_, stamp);
  const double device_s = 1e-6 * static_cast<double>(device_us);
  if (device_s < -kBack || device_s - hub_s > kAhead) {
    begin(stamp);
    return true;
  }
  elapsed_us_ += device_us;
  last_ = stamp;
  const double device = 1e-6 * static_cast<double>(elapsed_us_);
  keep({.device = device, .lead = 1e-9 * static_cast<double>(stamp.receipt_ns - first_ns_) - device});
  return false;
}

void RoughClock::keep(const clocks::Stamp& stamp) {
  constexpr std::size_t kMax = 1024;
  const auto bin = [this](const clocks::Stamp& s) { return std::floor(s.device / width_); };
  auto& last = lowest_.back();
  if (bin(stamp) <= bin(last)) {
    if (stamp.lead < last.lead && stamp.device >= last.device) last = stamp;
    return;
  }
  lowest_.push_back(stamp);
  if (lowest_.size() < kMax) return;
  width_ *= 2;
  std::vector<clocks::Stamp> coarser;
  for (const auto& s : lowest_) {
    if (coarser.empty() || bin(s) > bin(coarser.back())) {
      coarser.push_back(s);
    } else if (s.lead < coarser.back().lead) {
      coarser.back() = s;
    }
  }
  lowest_ = std::move(coarser);
}

std::optional<double> RoughClock::skew() const {
  constexpr double kShortest = 10;
  if (lowest_.empty() || lowest_.back().device < kShortest) return {};
  return clocks::hull_slope(lowest_, lowest_.back().device / 2);
}

}  // namespace crisp::devices
