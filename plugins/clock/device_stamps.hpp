// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "pipeline/clocks/counted_time.hpp"
#include "pipeline/clocks/unwrap.hpp"
#include "pipeline/data/clock_map.hpp"
#include "plugins/clock/fitted_clock.hpp"

namespace crisp {

/// A time in which nothing came from a device.
struct SilentTime {
  double begin = 0;     ///< [s since the epoch] receipt of the last item before it
  double duration = 0;  ///< [s]
};

/// What became of one device's telegrams or readings.
struct DeviceReport {
  ClockMap clock;
  std::uint64_t received = 0;
  std::uint64_t lost = 0;      ///< by the gaps of its counter; 0 where it has none
  std::uint64_t repeated = 0;  ///< came twice or out of order: left out
  std::uint64_t damaged = 0;   ///< with times that fit nothing before or after: left out
  std::uint64_t resets = 0;    ///< of its clock
  std::vector<SilentTime> silences;
  std::vector<StampStep> clock_steps;  ///< by how much its clock jumped: forwards
  std::vector<StampStep> delay_steps;  ///< by how much its shortest delay grew
};

/// Takes in the stamps of one device: unwraps its counter and its clock, fits the clock, and counts what is
/// missing, repeated or damaged.
class DeviceStamps {
 public:
  struct Arrival {
    StampKind kind = StampKind::next;
    std::int64_t device_us = 0;  ///< unwrapped, and without the steps of its clock
    std::int64_t steps = 1;      ///< of the counter since the one before; 1 after a reset
  };

  /// @param period [s] nominal time between two counts; 0 if it is not known
  DeviceStamps(std::string device, FittedClock clock, double period);

  /// @param hub         [s since the epoch] receipt
  /// @param handover_us [µs] by how much later than what is counted, and comes evenly, it was sent
  /// @throws Error as TimeUnwrapper::add
  Arrival accept(std::uint16_t counter, std::uint32_t raw_us, std::int64_t receipt_ns, double hub,
                 std::int64_t handover_us = 0);
  void set_period(double seconds) { period_ = seconds; }
  double period() const { return period_; }  ///< [s] of device time between two counts; 0 if not known

  FittedClock& clock() { return clock_; }
  const FittedClock& clock() const { return clock_; }
  const ClockMap& map() const { return clock_.map(); }
  void count_damaged() { ++report_.damaged; }
  void trust_counter(bool numbered) { numbered_ = numbered_ && numbered; }  ///< of what is accepted next
  DeviceReport report() const;

 private:
  struct Last {
    std::int64_t receipt_ns = 0;
    std::int64_t device_us = 0;  // by its clock, steps and all
    std::int64_t handover_us = 0;
    std::int64_t even_us = 0;  // without them
    CounterUnwrapper counter;
  };
  /// Looks for a step of the clock since the last.
  void watch_count(const Last& now, std::int64_t steps, double hub);
  std::int64_t even(const Last& now) const;
  /// The steps of the counter or, where they contradict the device's time, those that its time makes likely.
  std::int64_t plausible_steps(std::int64_t steps, double device_s) const;
  std::int64_t count_steps(std::int64_t steps, std::int64_t even_us);
  void note_silence(double hub);

  TimeUnwrapper time_;
  CountedTime counted_;
  FittedClock clock_;
  DeviceReport report_;
  bool any_ = false;
  bool numbered_ = true;  ///< all of them by the device itself
  Last last_;
  Last before_reset_;
  double last_hub_ = 0;
  double stepped_at_ = 0;  ///< [s since the epoch] where its clock may have stepped
  double period_;          ///< [s] between two counts, as far as it is known
  double counted_time_ = 0;
  std::int64_t counted_steps_ = 0;
  std::int64_t pairs_ = 0;          ///< of items that follow one another
  std::int64_t smallest_step_ = 0;  ///< the output interval
};

}  // namespace crisp
