// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/clock/unwrap.hpp"

#include <algorithm>
#include <cmath>

#include "pipeline/data/error.hpp"

namespace crisp {
namespace {

constexpr std::int64_t kTimeModulus = std::int64_t{1} << 32;
constexpr double kMostDelay = 30;      // [s] a stalled TCP connection hands out its scans that late
constexpr double kMostSkew = 1e-3;     // of a crystal, with a wide margin
constexpr double kMostDisorder = 0.5;  // [s] datagrams overtake each other, but not by more
constexpr double kLeastStep = 0.25;    // [s] a clock that two others contradict by this much has jumped
constexpr std::uint32_t kSecond_us = 1'000'000;

}  // namespace

std::int64_t nearest_congruent(std::int64_t residue, std::int64_t modulus, double expected) {
  return residue +
         modulus * std::llround((expected - static_cast<double>(residue)) / static_cast<double>(modulus));
}

std::int64_t CounterUnwrapper::advance(std::uint16_t raw, double expected) const {
  return nearest_congruent(std::int64_t{raw} - last_, 65536, expected);
}

TimeUnwrapper::Unwrapped TimeUnwrapper::add(std::uint32_t raw_us, std::int64_t receipt_ns,
                                            std::optional<double> counted_s) {
  largest_raw_us_ = std::max(largest_raw_us_, raw_us);
  const double hub_s = any_ ? 1e-9 * static_cast<double>(receipt_ns - last_receipt_ns_) : 0;
  std::int64_t advance_us = nearest_congruent(std::int64_t{raw_us} - last_raw_us_, kTimeModulus, 1e6 * hub_s);
  StampKind kind = StampKind::next;
  if (any_) {
    kind = judge(1e-6 * static_cast<double>(advance_us), hub_s, counted_s);
  } else {
    advance_us = raw_us;
  }
  if (kind == StampKind::repeated) return {kind, last_us_ + advance_us};
  if (kind == StampKind::reset) {
    refuse_seconds_clock(raw_us);
    advance_us = std::max<std::int64_t>(1, std::llround(1e6 * hub_s));
  }
  any_ = true;
  last_raw_us_ = raw_us;
  last_us_ += advance_us;
  last_receipt_ns_ = receipt_ns;
  return {kind, last_us_};
}

StampKind TimeUnwrapper::judge(double device_s, double hub_s, std::optional<double> counted_s) const {
  if (device_s <= 0) return device_s >= -kMostDisorder ? StampKind::repeated : StampKind::reset;
  const double off_hub = std::abs(device_s - hub_s);
  if (counted_s) {
    const double off_count = std::abs(device_s - *counted_s);
    const double others = std::abs(hub_s - *counted_s);
    if (std::min(off_hub, off_count) > std::max(kLeastStep, 2 * others)) return StampKind::reset;
  }
  const bool as_hub = off_hub <= kMostDelay + kMostSkew * std::abs(hub_s);
  const bool as_count = counted_s && std::abs(device_s - *counted_s) <= 0.1 + 0.01 * *counted_s;
  return as_hub || as_count ? StampKind::next : StampKind::reset;
}

void TimeUnwrapper::refuse_seconds_clock(std::uint32_t raw_us) {
  if (raw_us < last_raw_us_) ++falls_;
  if (falls_ < 2 || largest_raw_us_ >= kSecond_us) return;
  throw Error("the clock of " + device_ + " wraps every second: it never reached 1 s and fell back twice",
              "update the firmware of " + device_ + ", or align by receipt times with clock.receipt");
}

}  // namespace crisp
