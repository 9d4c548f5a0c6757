// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/clock/device_stamps.hpp"

#include <algorithm>
#include <cmath>

namespace crisp {
namespace {

constexpr double kSilence = 1;  // [s]
constexpr std::size_t kMostSilences = 1000;

}  // namespace

DeviceStamps::DeviceStamps(std::string device, FittedClock clock, double period)
    : time_(std::move(device)), clock_(std::move(clock)), period_(period) {}

DeviceStamps::Arrival DeviceStamps::accept(std::uint16_t counter, std::uint32_t raw_us,
                                           std::int64_t receipt_ns, double hub) {
  ++report_.received;
  std::int64_t steps = 1;
  std::optional<double> counted_s;
  if (any_) {
    const double hub_s = 1e-9 * static_cast<double>(receipt_ns - last_.receipt_ns);
    steps = last_.counter.advance(counter, period_ > 0 ? hub_s / period_ : 1);
    if (period_ > 0) counted_s = static_cast<double>(steps) * period_;
  }
  const auto [kind, device_us] = time_.add(raw_us, receipt_ns, counted_s);
  switch (kind) {
    case StampKind::repeated:
      ++report_.repeated;
      return {kind, device_us, steps};
    case StampKind::reset:
      ++report_.resets;
      before_reset_ = last_;
      clock_.cut();
      steps = 1;
      break;
    case StampKind::returned:
      --report_.resets;
      ++report_.damaged;
      clock_.drop_last_segment();
      last_ = before_reset_;
      steps = count_steps(last_.counter.advance(counter, 1), device_us);
      break;
    case StampKind::next:
      if (any_) steps = count_steps(steps, device_us);
  }
  note_silence(hub);
  any_ = true;
  last_.receipt_ns = receipt_ns;
  last_.device_us = device_us;
  last_.counter.accept(counter);
  clock_.add(device_us, hub);
  return {kind, device_us, steps};
}

std::int64_t DeviceStamps::plausible_steps(std::int64_t steps, double device_s) const {
  if (period_ <= 0) return std::max<std::int64_t>(steps, 1);
  const double off = std::abs(static_cast<double>(steps) * period_ - device_s);
  if (steps > 0 && off <= 10 * period_ + 0.05 * device_s) return steps;
  return std::max<std::int64_t>(1, std::llround(device_s / period_));
}

std::int64_t DeviceStamps::count_steps(std::int64_t steps, std::int64_t device_us) {
  const double device_s = 1e-6 * static_cast<double>(device_us - last_.device_us);
  steps = plausible_steps(steps, device_s);
  counted_time_ += device_s;
  counted_steps_ += steps;
  ++pairs_;
  period_ = counted_time_ / static_cast<double>(counted_steps_);
  smallest_step_ = smallest_step_ == 0 ? steps : std::min(smallest_step_, steps);
  return steps;
}

void DeviceStamps::note_silence(double hub) {
  if (any_ && hub - last_hub_ >= kSilence && report_.silences.size() < kMostSilences) {
    report_.silences.push_back({.begin = last_hub_, .duration = hub - last_hub_});
  }
  last_hub_ = std::max(last_hub_, hub);
}

DeviceReport DeviceStamps::report() const {
  DeviceReport report = report_;
  report.clock = clock_.map();
  if (smallest_step_ > 0) {
    report.lost =
        static_cast<std::uint64_t>(std::max<std::int64_t>(0, counted_steps_ / smallest_step_ - pairs_));
  }
  return report;
}

}  // namespace crisp
