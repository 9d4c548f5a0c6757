// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/devices/rough_clock.hpp"

#include <algorithm>

#include "grabbers/devices/congruent.hpp"

namespace crisp {

void RoughClock::begin(std::uint32_t device_us, std::int64_t receipt_ns) {
  begun_ = true;
  last_us_ = device_us;
  last_ns_ = first_ns_ = receipt_ns;
  elapsed_us_ = 0;
  width_ = 1;
  lowest_.assign(1, {});
}

bool RoughClock::take(std::uint32_t device_us, std::int64_t receipt_ns) {
  if (!begun_) {
    begin(device_us, receipt_ns);
    return false;
  }
  constexpr double kWrap = 4294967296.0, kBack = 0.5e6, kAhead = 60e6;  // [µs]
  const double hub = 1e-3 * static_cast<double>(receipt_ns - last_ns_);
  const double device = nearest_congruent(static_cast<std::uint32_t>(device_us - last_us_), kWrap, hub);
  if (device < -kBack || device - hub > kAhead) {
    begin(device_us, receipt_ns);
    return true;
  }
  elapsed_us_ += device;
  last_us_ = device_us;
  last_ns_ = receipt_ns;
  keep({1e-6 * elapsed_us_, 1e-9 * static_cast<double>(receipt_ns - first_ns_) - 1e-6 * elapsed_us_});
  return false;
}

void RoughClock::keep(const Stamp& stamp) {
  constexpr std::size_t kMax = 1024;
  const auto bin = [this](const Stamp& s) { return std::floor(s.device / width_); };
  auto& last = lowest_.back();
  if (bin(stamp) <= bin(last)) {
    if (stamp.delay < last.delay && stamp.device >= last.device) last = stamp;
    return;
  }
  lowest_.push_back(stamp);
  if (lowest_.size() < kMax) return;
  width_ *= 2;
  std::vector<Stamp> coarser;
  for (const auto& s : lowest_) {
    if (coarser.empty() || bin(s) > bin(coarser.back())) {
      coarser.push_back(s);
    } else if (s.delay < coarser.back().delay) {
      coarser.back() = s;
    }
  }
  lowest_ = std::move(coarser);
}

std::optional<double> RoughClock::skew() const {
  constexpr double kShortest = 10;
  if (lowest_.empty() || lowest_.back().device < kShortest) return {};
  std::vector<Stamp> hull;  // Andrew's monotone chain, lower half
  for (const auto& c : lowest_) {
    while (hull.size() >= 2) {
      const auto &a = hull[hull.size() - 2], &b = hull.back();
      if ((b.delay - a.delay) * (c.device - b.device) < (c.delay - b.delay) * (b.device - a.device)) break;
      hull.pop_back();
    }
    hull.push_back(c);
  }
  const double middle = lowest_.back().device / 2;
  const auto after =
      std::find_if(hull.begin() + 1, hull.end(), [&](const Stamp& s) { return s.device >= middle; });
  const auto before = after - 1;
  return (after->delay - before->delay) / (after->device - before->device);
}

}  // namespace crisp
