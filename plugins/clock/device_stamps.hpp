// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <crisp/clock_aligner.hpp>
#include <crisp/clock_map.hpp>

#include "pipeline/clocks/counted_time.hpp"
#include "pipeline/clocks/unwrap.hpp"
#include "plugins/clock/windowed_clock_fit.hpp"

namespace crisp::clock {

/// Treatment of a device whose clock stands still.
enum class StandingClock {
  leave_out,   ///< what carries the stamp of the one before is of no use
  by_receipt,  ///< the receipts take the place of its clock
};

/// Processes the stamps of one device: unwraps its counter and its clock, fits the clock, and counts
/// missing, repeated and damaged ones.
class DeviceStamps {
 public:
  struct Arrival {
    clocks::StampKind kind = clocks::StampKind::next;
    std::int64_t device_us = 0;  ///< unwrapped, and without the steps of its clock
    std::int64_t steps = 1;      ///< of the counter since the one before; 1 after a reset
  };

  /// @param period [s] nominal time between two counts; 0 if it is not known
  DeviceStamps(std::string device, WindowedClockFit clock, double period,
               StandingClock standing = StandingClock::leave_out);

  /// @param hub         [s since the epoch] receipt
  /// @param handover_us [µs] by how much later than what is counted, and comes evenly, it was sent
  /// @throws Error as TimeUnwrapper::add
  Arrival accept(std::uint16_t counter, std::uint32_t raw_us, std::int64_t receipt_ns, double hub,
                 std::int64_t handover_us = 0);
  void set_period(double seconds) { period_ = seconds; }
  double period() const { return period_; }  ///< [s] of device time between two counts; 0 if not known

  WindowedClockFit& clock() { return clock_; }
  const WindowedClockFit& clock() const { return clock_; }
  const std::optional<ClockMap>& map() const { return clock_.map(); }
  /// An item came that is of no use, as its times contradict each other.
  void count_damaged() {
    ++report_.received;
    ++report_.damaged;
  }
  void trust_counter(bool numbered) { numbered_ = numbered_ && numbered; }  ///< of what is accepted next
  DeviceReport report() const;
  /// With the silences before the first and after the last item of a recording [s since the epoch].
  DeviceReport report(double begin, double end) const;

 private:
  struct Last {
    std::uint32_t raw_us = 0;
    std::int64_t receipt_ns = 0;
    std::int64_t device_us = 0;  // by its clock, steps and all
    std::int64_t handover_us = 0;
    std::int64_t even_us = 0;  // without them
    clocks::CounterUnwrapper counter;
  };
  /// Detects a step of the clock since the last stamp.
  void watch_count(const Last& now, std::int64_t steps, double hub);
  std::int64_t even(const Last& now) const;
  /// The steps of the counter or, where they contradict the device's time, those that its time makes likely.
  std::int64_t plausible_steps(std::int64_t steps, double device_s) const;
  std::int64_t count_steps(std::int64_t steps, std::int64_t even_us);
  void count_useless(std::uint16_t counter, std::uint32_t raw_us, double hub);
  /// @param device_s  [s] since the stamp before; 0 where the clock does not go on from it
  void note_silence(double hub, double device_s);

  StandingClock standing_;
  clocks::TimeUnwrapper time_;
  clocks::CountedTime counted_;
  WindowedClockFit clock_;
  DeviceReport report_;
  bool any_ = false;
  bool receipts_begin_ = false;  ///< with the next item they take the place of its clock
  bool numbered_ = true;         ///< all of them by the device itself
  Last last_;
  Last before_reset_;
  double first_hub_ = 0;
  double last_hub_ = 0;
  double moved_hub_ = 0;   ///< [s since the epoch] when its clock was last seen to move
  double stepped_at_ = 0;  ///< [s since the epoch] where its clock may have stepped
  double period_;          ///< [s] between two counts, as far as it is known
  double counted_time_ = 0;
  std::int64_t counted_steps_ = 0;
  std::int64_t pairs_ = 0;          ///< of items that follow one another
  std::int64_t smallest_step_ = 0;  ///< the output interval
};

}  // namespace crisp::clock
