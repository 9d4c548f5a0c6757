// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <crisp/findings.hpp>

#include "pipeline/clocks/clock_line.hpp"
#include "pipeline/clocks/hub_deviation.hpp"
#include "pipeline/clocks/unwrap.hpp"

namespace crisp::diagnose {

inline constexpr double kStampQuantum = 1e-6;  ///< [s] resolution of device times

/// Device time, receipt time and counter of one telegram.
struct CountedStamp {
  std::int64_t count = 0;  ///< device's counter, unwrapped
  clocks::Stamp stamp;     ///< device time since the first stamp, and the receipt's lead over it
};

/// Stamps of one device in order of receipt, with counter and clock unwrapped. A jump of the clock appears as
/// a jump of the lead.
class StampTrack {
 public:
  /// @param counter    wraps at 65536
  /// @param device_us  [µs] wraps at 2³²
  /// @param receipt_ns [ns]
  void add(std::uint16_t counter, std::uint32_t device_us, std::int64_t receipt_ns);
  /// Takes out a deviation of the hub's clock, and the stamps that may have come before or after a step of
  /// it.
  ///
  /// @param hub_s  [s] hub time of the first stamp, on the deviation's scale
  void take_out(const clocks::HubDeviation& deviation, double hub_s);
  std::span<const CountedStamp> stamps() const { return stamps_; }
  std::int64_t first_ns() const { return first_ns_; }  ///< [ns] receipt time of the first stamp

 private:
  std::vector<CountedStamp> stamps_;
  clocks::CounterUnwrapper counter_;
  clocks::DeviceStamp last_;
  std::int64_t first_ns_ = 0;
  std::int64_t device_us_ = 0;  // since the first
};

/// Clock and link of a device without deviations; kNotTested where there are too few stamps.
struct ClockFacts {
  double skew = kNotTested;  ///< hub seconds per device second − 1
  double skew_std_error = kNotTested;
  double delay_median = kNotTested;  ///< [s] beyond the minimum delay
  double delay_95 = kNotTested;      ///< [s]
};

inline constexpr std::size_t kMinOfClock = 10;  ///< minimum number of stamps for a clock

/// Estimates skew and delays of a device.
ClockFacts clock_facts(std::span<const CountedStamp> stamps);

/// Clock line: the best straight line below all stamps (lower convex hull), in any order.
clocks::ClockLine line_of(std::vector<clocks::Stamp> stamps);

/// The stamps without their counts.
std::vector<clocks::Stamp> without_counts(std::span<const CountedStamp> stamps);

inline constexpr std::size_t kTurnsOfPiece = 8;  ///< turns over which a mirror's period is averaged

/// Rotation of a mirror by its index stamps.
struct MirrorFacts {
  double period = 0;  ///< [s] mean, on the device's clock
  double period_std_error = 0;
  double wander = 0;            ///< relative RMS of slow changes of the period
  std::vector<double> periods;  ///< [s] of segments of eight turns
  std::vector<double> begin;    ///< [s since the first telegram] of the segments
};

/// Splits index passes into segments without a break: none spans a restart or a step of the device's clock.
///
/// @param step_interval  [s] interval of receipt times that contains the step of the clock
std::vector<std::span<const CountedStamp>> unbroken_segments(
    std::span<const CountedStamp> passes, const std::optional<std::array<double, 2>>& step_interval = {});

/// Estimates a mirror's period from its index passes.
///
/// @param passes  stamps of the mirror's index with the number of the turn; intervals across a break are
/// skipped
/// @return  empty for fewer than eight segments, which give no variance
std::optional<MirrorFacts> mirror_facts(std::span<const CountedStamp> passes,
                                        const std::optional<std::array<double, 2>>& step_interval = {});

/// Converts the period to the hub's clock: the skew may be as large as the mirror's deviation.
MirrorFacts on_hubs_clock(MirrorFacts facts, const ClockFacts& clock);

/// Held-out gain of the estimated period over the nominal one [s]: every other segment is predicted by the
/// rest.
Gain gain_over_nominal(const MirrorFacts& facts, double nominal, std::uint64_t seed);

}  // namespace crisp::diagnose
