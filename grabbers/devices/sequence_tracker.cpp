// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/devices/sequence_tracker.hpp"

namespace crisp::devices {

std::int64_t SequenceTracker::steps_to(std::uint16_t counter, std::int64_t time_ns) const {
  const double expected =
      elapsed_ns_ > 0 ? static_cast<double>(time_ns - last_ns_) * steps_ / elapsed_ns_ : 1;
  return last_.advance(counter, expected);
}

SequenceTracker::Verdict SequenceTracker::begin(std::uint16_t counter, std::uint32_t stamp,
                                                std::int64_t time_ns) {
  begun_ = true;
  last_.accept(counter);
  last_ns_ = time_ns;
  seen_ = 1;
  stamps_[counter % kRemembered] = stamp;
  return Verdict::First;
}

SequenceTracker::Verdict SequenceTracker::take(std::uint16_t counter, std::uint32_t stamp,
                                               std::int64_t time_ns) {
  if (!begun_) return begin(counter, stamp, time_ns);
  const auto steps = steps_to(counter, time_ns);
  auto& remembered = stamps_[counter % kRemembered];
  if (steps <= -kRemembered) return begin(counter, stamp, time_ns);  // a counter that was set
  if (steps <= 0) {
    const auto bit = std::uint64_t{1} << -steps;
    const bool seen = (seen_ & bit) != 0;
    if (seen) return remembered == stamp ? Verdict::Duplicate : Verdict::Next;  // else a counter that stands
    seen_ |= bit;
    remembered = stamp;
    if (lost_ > 0) --lost_;
    return Verdict::Late;
  }
  lost_ += static_cast<std::uint64_t>(steps - 1);
  seen_ = steps < kRemembered ? (seen_ << steps) | 1 : 1;
  remembered = stamp;
  if (steps < kRemembered) {
    // Over many items: those that waited for a busy machine come all at once, which is not their rate.
    constexpr double kKept = 1 - 1.0 / 4096;
    elapsed_ns_ = kKept * elapsed_ns_ + static_cast<double>(time_ns - last_ns_);
    steps_ = kKept * steps_ + static_cast<double>(steps);
  }
  last_.accept(counter);
  last_ns_ = time_ns;
  return Verdict::Next;
}

}  // namespace crisp::devices
