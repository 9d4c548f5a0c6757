// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include <crisp/capture_statistics.hpp>

#include "grabbers/devices/rough_clock.hpp"
#include "grabbers/devices/sequence_tracker.hpp"
#include "pipeline/clocks/pauses.hpp"

namespace crisp::devices {

/// Timeline of one device, made while its items are read: its counter and its clock, unwrapped from item to
/// item, with the verdict on each item, and its losses, resets, silences and pauses.
class DeviceTimeline {
 public:
  struct Item {
    std::uint16_t counter = 0;  ///< wraps
    clocks::DeviceStamp stamp;  ///< of sending
    bool is_polled = false;     ///< a client requested it: gaps of the counter are no losses
  };
  struct Arrival {
    bool is_new = true;        ///< it did not come before
    bool begins_anew = false;  ///< clock and counter have nothing in common with those before
  };

  /// @param pauses  of all devices, if there may be several recordings; outlives this
  explicit DeviceTimeline(clocks::Pauses* pauses) : pauses_(pauses) {}

  /// Judges the next item that came.
  Arrival judge(const Item& item);
  /// Notes that an item is passed on: it ends a silence.
  void pass_on(const clocks::DeviceStamp& stamp);

  /// Adds what is known to the device's statistics.
  /// @param lost  name of the items that never came
  void add_to(DeviceStatistics& statistics, std::string_view lost) const;

 private:
  bool ends_pause(std::int64_t time_ns);

  clocks::Pauses* pauses_;
  SequenceTracker tracker_;
  RoughClock clock_;
  std::int64_t unrequested_ = 0;  ///< among the tracker's gaps: items that a polling client did not request
  Counts notes_;
  std::uint64_t items_ = 0;  ///< passed on
  std::uint64_t standing_ = 0;
  clocks::DeviceStamp last_;     ///< of the last one passed on
  bool has_begun_anew_ = false;  ///< clock and counter, since then
  std::int64_t first_ns_ = 0, last_ns_ = 0;
  double longest_silence_ = 0;  ///< [s]
  std::int64_t silence_ns_ = 0;
  std::uint64_t pause_count_ = 0;
  std::int64_t paused_ns_ = 0;
};

}  // namespace crisp::devices
