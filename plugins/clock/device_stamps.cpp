// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/clock/device_stamps.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "pipeline/clocks/silence.hpp"

namespace crisp::clock {
namespace {

using clocks::StampKind;

constexpr double kSilence = 1;           // [s]
constexpr std::size_t kMaxNoted = 1000;  // silences, and steps
constexpr std::uint64_t kStanding = 5;   // stamps in a row that are the same: the clock stands still

}  // namespace

DeviceStamps::DeviceStamps(std::string device, WindowedClockFit clock, double period, StandingClock standing)
    : standing_(standing), time_(std::move(device)), clock_(std::move(clock)), period_(period) {}

DeviceStamps::Arrival DeviceStamps::accept(std::uint16_t counter, std::uint32_t raw_us,
                                           std::int64_t receipt_ns, double hub, std::int64_t handover_us) {
  ++report_.received;
  if (report_.by_receipt) raw_us = static_cast<std::uint32_t>(receipt_ns / 1000);
  std::int64_t steps = 1;
  std::optional<double> counted_s;
  if (any_) {
    const double hub_s = 1e-9 * static_cast<double>(receipt_ns - last_.receipt_ns);
    steps = last_.counter.advance(counter, period_ > 0 ? hub_s / period_ : 1);
    if (period_ > 0) counted_s = static_cast<double>(steps) * period_;
  }
  auto [kind, device_us] = time_.add(raw_us, receipt_ns, counted_s);
  const bool goes_on = any_ && kind == StampKind::next;
  note_silence(hub, goes_on ? 1e-6 * static_cast<double>(device_us - last_.device_us) : 0);
  Last now{.raw_us = raw_us, .receipt_ns = receipt_ns, .device_us = device_us, .handover_us = handover_us};
  now.counter.accept(counter);
  switch (kind) {
    case StampKind::repeated:
      count_useless(counter, raw_us, hub);
      return {kind, device_us, steps};
    case StampKind::reset:
      if (std::exchange(receipts_begin_, false)) {
        kind = StampKind::next;  // the device went on
      } else {
        ++report_.resets;
      }
      before_reset_ = last_;
      clock_.cut();
      counted_.begin_anew();
      now.even_us = even(now);
      steps = 1;
      break;
    case StampKind::returned:
      --report_.resets;
      ++report_.damaged;
      clock_.drop_last_segment();
      counted_.begin_anew();
      last_ = before_reset_;
      now.even_us = even(now);
      steps = count_steps(last_.counter.advance(counter, 1), now.even_us);
      break;
    case StampKind::next:
      if (any_) watch_count(now, steps, hub);
      now.even_us = even(now);
      if (any_) steps = count_steps(steps, now.even_us);
  }
  moved_hub_ = hub;
  if (counted_.is_sure() && (!any_ || now.even_us > last_.even_us)) clock_.add(now.even_us, hub);
  any_ = true;
  last_ = now;
  return {kind, now.even_us, steps};
}

void DeviceStamps::watch_count(const Last& now, std::int64_t steps, double hub) {
  if (steps <= 0) return;
  const std::int64_t interval_us = (now.device_us - now.handover_us) - (last_.device_us - last_.handover_us);
  const bool was_sure = counted_.is_sure();
  counted_.add(1e-6 * static_cast<double>(interval_us), steps,
               1e-9 * static_cast<double>(now.receipt_ns - last_.receipt_ns));
  if (was_sure && !counted_.is_sure()) {
    stepped_at_ = hub;
    clock_.drop_last();  // what was counted before the step may have been sent after it
  }
  if (const auto by = counted_.confirmed(); by && report_.clock_steps.size() < kMaxNoted) {
    report_.clock_steps.push_back({.at = stepped_at_, .by = *by});
  }
}

/// The time of sending, without the steps of the clock. Ascending even where a suspected step turned out to
/// be none.
std::int64_t DeviceStamps::even(const Last& now) const {
  const std::int64_t even_us = now.device_us - std::llround(1e6 * counted_.jumped());
  return any_ ? std::max(even_us, last_.even_us - last_.handover_us + now.handover_us + 1) : even_us;
}

std::int64_t DeviceStamps::plausible_steps(std::int64_t steps, double device_s) const {
  if (period_ <= 0) return std::max<std::int64_t>(steps, 1);
  const double off = std::abs(static_cast<double>(steps) * period_ - device_s);
  if (steps > 0 && off <= 10 * period_ + 0.05 * device_s) return steps;
  return std::max<std::int64_t>(1, std::llround(device_s / period_));
}

std::int64_t DeviceStamps::count_steps(std::int64_t steps, std::int64_t even_us) {
  const double device_s = 1e-6 * static_cast<double>(even_us - last_.even_us);
  steps = plausible_steps(steps, device_s);
  counted_time_ += device_s;
  counted_steps_ += steps;
  ++pairs_;
  period_ = counted_time_ / static_cast<double>(counted_steps_);
  smallest_step_ = smallest_step_ == 0 ? steps : std::min(smallest_step_, steps);
  return steps;
}

void DeviceStamps::count_useless(std::uint16_t counter, std::uint32_t raw_us, double hub) {
  if (raw_us != last_.raw_us) {
    ++report_.late;
  } else if (counter == last_.counter.last()) {
    ++report_.repeated;
  } else {
    ++report_.standing;
    report_.standstill = std::max(report_.standstill, hub - moved_hub_);
    report_.by_receipt = standing_ == StandingClock::by_receipt && report_.standing >= kStanding;
    receipts_begin_ = report_.by_receipt;
  }
}

void DeviceStamps::note_silence(double hub, double device_s) {
  if (report_.received == 1) first_hub_ = last_hub_ = hub;
  const double silence = clocks::silence_between(hub - last_hub_, device_s);
  if (silence >= kSilence && report_.silences.size() < kMaxNoted)
    report_.silences.push_back({.begin = last_hub_, .duration = silence});
  last_hub_ = std::max(last_hub_, hub);
}

DeviceReport DeviceStamps::report(double begin, double end) const {
  DeviceReport report = this->report();
  if (report.received == 0) return report;
  auto& silences = report.silences;
  if (first_hub_ - begin >= kSilence) {
    silences.insert(silences.begin(), {.begin = begin, .duration = first_hub_ - begin});
  }
  if (end - last_hub_ >= kSilence) silences.push_back({.begin = last_hub_, .duration = end - last_hub_});
  return report;
}

DeviceReport DeviceStamps::report() const {
  DeviceReport report = report_;
  report.device = clock_.device();
  report.clock = clock_.map();
  report.stamps = clock_.stamps();
  report.delay_steps = clock_.delay_steps();
  if (numbered_ && smallest_step_ > 0) {
    report.lost =
        static_cast<std::uint64_t>(std::max<std::int64_t>(0, counted_steps_ / smallest_step_ - pairs_));
  }
  return report;
}

}  // namespace crisp::clock
