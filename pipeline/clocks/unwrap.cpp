// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/clocks/unwrap.hpp"

#include <algorithm>
#include <cmath>

#include <crisp/error.hpp>

#include "pipeline/clocks/clock_line.hpp"

namespace crisp::clocks {
namespace {

constexpr std::int64_t kTimeModulus = std::int64_t{1} << 32;
constexpr double kMaxDelay = 30;      // [s] a stalled TCP connection hands out its scans that late,
constexpr double kOddDelay = 1;       // [s] but with their counters in order: if not, it is no stall
constexpr double kMaxDisorder = 0.5;  // [s] datagrams overtake each other, but not by more
constexpr double kMinStep = 0.25;     // [s] a clock that two others contradict by this much has jumped
constexpr std::uint32_t kSecond_us = 1'000'000;

}  // namespace

std::int64_t epoch_of_run(std::int64_t first_receipt_ns) {
  constexpr std::int64_t kSecond_ns = 1'000'000'000;
  const std::int64_t later = first_receipt_ns + kSecond_ns / 2;
  return later - (later % kSecond_ns + kSecond_ns) % kSecond_ns;
}

std::int64_t nearest_congruent(std::int64_t residue, std::int64_t modulus, double expected) {
  return residue +
         modulus * std::llround((expected - static_cast<double>(residue)) / static_cast<double>(modulus));
}

ElapsedTime elapsed(const DeviceStamp& from, const DeviceStamp& to) {
  const double hub_s = 1e-9 * static_cast<double>(to.receipt_ns - from.receipt_ns);
  return {hub_s, nearest_congruent(std::int64_t{to.device_us} - from.device_us, kTimeModulus, 1e6 * hub_s)};
}

std::int64_t CounterUnwrapper::advance(std::uint16_t raw, double expected) const {
  return nearest_congruent(std::int64_t{raw} - last_, 65536, expected);
}

TimeUnwrapper::Unwrapped TimeUnwrapper::add(std::uint32_t raw_us, std::int64_t receipt_ns,
                                            std::optional<double> counted_s) {
  const DeviceStamp stamp{.receipt_ns = receipt_ns, .device_us = raw_us};
  largest_raw_us_ = std::max(largest_raw_us_, raw_us);
  const auto go_on = [&](StampKind kind, std::int64_t device_us) {
    if (kind != StampKind::reset) before_reset_.reset();
    last_ = {.stamp = stamp, .device_us = device_us};
    return Unwrapped{kind, device_us};
  };
  if (!last_) return go_on(StampKind::next, raw_us);
  const ElapsedTime step = elapsed(last_->stamp, stamp);
  const StampKind kind = judge(step, counted_s);
  if (kind == StampKind::next) return go_on(kind, last_->device_us + step.device_us);
  if (kind == StampKind::repeated) return {kind, last_->device_us + step.device_us};
  if (before_reset_) {
    const ElapsedTime back = elapsed(before_reset_->stamp, stamp);
    if (judge(back, std::nullopt) == StampKind::next) {
      return go_on(StampKind::returned, before_reset_->device_us + back.device_us);
    }
  }
  refuse_seconds_clock(raw_us);
  before_reset_ = last_;
  return go_on(kind,
               last_->device_us + kResetGap_us + std::max<std::int64_t>(0, std::llround(1e6 * step.hub_s)));
}

StampKind TimeUnwrapper::judge(const ElapsedTime& step, std::optional<double> counted_s) {
  const double device_s = 1e-6 * static_cast<double>(step.device_us);
  if (device_s <= 0) return device_s >= -kMaxDisorder ? StampKind::repeated : StampKind::reset;
  const double off_hub = std::abs(device_s - step.hub_s);
  if (counted_s) {
    const double off_count = std::abs(device_s - *counted_s);
    const double others = std::abs(step.hub_s - *counted_s);
    if (std::min(off_hub, off_count) > std::max(kMinStep, 2 * others)) return StampKind::reset;
  }
  const double most_delay = counted_s ? kOddDelay : kMaxDelay;
  const bool as_hub = off_hub <= most_delay + kMaxSkew * std::abs(step.hub_s);
  const bool as_count = counted_s && std::abs(device_s - *counted_s) <= 0.1 + 0.01 * *counted_s;
  return as_hub || as_count ? StampKind::next : StampKind::reset;
}

void TimeUnwrapper::refuse_seconds_clock(std::uint32_t raw_us) {
  if (raw_us < last_->stamp.device_us) ++falls_;
  if (falls_ < 2 || largest_raw_us_ >= kSecond_us) return;
  throw Error("the clock of " + device_ + " wraps every second: it never reached 1 s and fell back twice",
              "update the firmware of " + device_ + ": the second of a stamp is ambiguous");
}

}  // namespace crisp::clocks
