// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/devices/device_timeline.hpp"

#include <algorithm>
#include <utility>

#include "pipeline/clocks/silence.hpp"

namespace crisp::devices {
namespace {

constexpr const char* kReceiptJumps =
    "receipts that jump by over 0.5 s against the device's clock (the hub's clock was set, or items waited)";

}  // namespace

/// Counter gaps across a pause between two recordings are no loss, and clocks may be others after it.
bool DeviceTimeline::ends_pause(std::int64_t time_ns) {
  if (pauses_ == nullptr) return false;
  pauses_->hear(time_ns);
  if (items_ == 0 || !pauses_->last_is_between(last_ns_, time_ns)) return false;
  ++pause_count_;
  paused_ns_ += time_ns - last_ns_;
  return true;
}

DeviceTimeline::Arrival DeviceTimeline::judge(const Item& item) {
  const bool is_reset = clock_.take(item.stamp);
  if (is_reset) notes_.add("restarts of the device's clock");
  const bool is_recording = ends_pause(item.stamp.receipt_ns);
  if (is_reset || is_recording) tracker_.restart();
  if (is_recording) {
    clock_.restart();
    clock_.take(item.stamp);
  }
  const auto missing = static_cast<std::int64_t>(tracker_.lost());
  const auto verdict = tracker_.take(item.counter, item.stamp.device_us, item.stamp.receipt_ns);
  if (item.is_polled) unrequested_ += static_cast<std::int64_t>(tracker_.lost()) - missing;
  if (verdict == SequenceTracker::Verdict::Late) notes_.add("items that came late");
  const bool is_new = verdict != SequenceTracker::Verdict::Duplicate;
  if (!is_new) notes_.add(item.is_polled ? "scans read twice by a client" : "items that came twice");
  has_begun_anew_ = has_begun_anew_ || is_reset || is_recording;
  return {.is_new = is_new, .begins_anew = is_reset || is_recording};
}

void DeviceTimeline::pass_on(const clocks::DeviceStamp& stamp) {
  const std::int64_t time_ns = stamp.receipt_ns;
  const std::uint32_t since_us = stamp.device_us - last_.device_us;  // wraps as they do
  const double receipt_s = 1e-9 * static_cast<double>(time_ns - last_.receipt_ns);
  last_ = stamp;
  const bool is_other_clock = std::exchange(has_begun_anew_, false);
  if (items_++ == 0) {
    first_ns_ = last_ns_ = time_ns;
    return;
  }
  if (since_us == 0) ++standing_;
  const double hub_s = 1e-9 * static_cast<double>(time_ns - last_ns_);
  if (!is_other_clock && clocks::is_receipt_jump(receipt_s, 1e-6 * static_cast<std::int32_t>(since_us)))
    notes_.add(kReceiptJumps);
  const double silence = clocks::silence_between(hub_s, 1e-6 * static_cast<double>(since_us));
  if (silence > longest_silence_) {
    longest_silence_ = silence;
    silence_ns_ = last_ns_;
  }
  first_ns_ = std::min(first_ns_, time_ns);
  last_ns_ = std::max(last_ns_, time_ns);
}

void DeviceTimeline::add_to(DeviceStatistics& statistics, std::string_view lost) const {
  const auto missing = static_cast<std::int64_t>(tracker_.lost());
  statistics.losses.add(lost, static_cast<std::uint64_t>(std::max<std::int64_t>(0, missing - unrequested_)));
  statistics.notes.add(notes_);
  if (unrequested_ > 0) {
    statistics.notes.add("scans between the requested ones", static_cast<std::uint64_t>(unrequested_));
  }
  statistics.items = items_;
  statistics.standing = standing_;
  statistics.first_ns = first_ns_;
  statistics.last_ns = last_ns_;
  statistics.longest_silence = longest_silence_;
  statistics.silence_ns = silence_ns_;
  statistics.pauses = pause_count_;
  statistics.paused_ns = paused_ns_;
  statistics.skew = clock_.skew();
}

}  // namespace crisp::devices
