// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <deque>

#include <crisp/plate_trajectory.hpp>
#include <crisp/scan.hpp>

#include "pipeline/data/encoder_smoothing.hpp"
#include "plugins/clock/device_stamps.hpp"
#include "plugins/clock/scan_timestamper.hpp"

namespace crisp::clock {

/// The encoder readings on their way to a trajectory.
class EncoderTimestamper {
 public:
  /// @throws Error if the rig gives no counts a revolution
  EncoderTimestamper(const RigPlate& plate, DeviceStamps stamps, TimeSource source);

  /// @param hub [s since the epoch] receipt
  /// @return whether the clock has another stamp
  /// @throws Error as DeviceStamps::accept
  bool add(const PlateReading& reading, double hub);
  /// State from which a later track determines whether the encoder's count continued.
  std::optional<clocks::DeviceStamp> latest_reading() const { return latest_; }
  /// To be called before the first reading, if there was another recording of this plate before.
  void follow_on(const clocks::DeviceStamp& before) { before_ = before; }

  /// The plate from the last reading at or before `begin` to the first at or after `end` [s since the epoch],
  /// as far as there are readings.
  PlateTrajectory piece(double begin, double end, std::int64_t epoch_ns, const PlateMotionSettings& settings);
  /// [s since the epoch] When the latest reading was taken, as the clock is known now.
  std::optional<double> latest() const;
  /// Forgets the readings before this hub time [s since the epoch].
  void forget_before(double hub);

  bool idle() const { return readings_.empty(); }
  WindowedClockFit& clock() { return stamps_.clock(); }
  const WindowedClockFit& clock() const { return stamps_.clock(); }
  /// With the silences before its first and after its last reading [s since the epoch].
  DeviceReport report(double begin, double end) const { return stamps_.report(begin, end); }
  /// Jumps of the count that no motion of the plate explains. Later counts are continued from before each.
  struct CountJumps {
    std::uint64_t by_turns = 0;  ///< of whole turns, as at an index pulse
    std::uint64_t others = 0;
    double largest = 0;  ///< [rad] of the others: by how much the count was ahead of the plate from then on
    double time = 0;     ///< [s since the epoch] of that one
  };
  CountJumps count_jumps() const;
  /// Readings that came after the encoder had lost its zero: of no use, the angles have nothing in common.
  std::uint64_t after_lost_zero() const { return after_lost_zero_; }
  /// Readings whose angle the plate cannot have reached since the one before them.
  std::uint64_t impossible() const { return impossible_; }
  /// Readings at the same hub time as the one before them.
  std::uint64_t simultaneous() const { return simultaneous_; }

 private:
  struct Reading {
    double device = 0;   ///< [s]
    double receipt = 0;  ///< [s since the epoch]
    std::int64_t count = 0;
  };
  struct Before {
    Reading last;
    std::int64_t ahead = 0;
    bool zero_is_lost = false;
  };
  double time(const Reading& reading) const;
  void undo_reset();
  void take(const Reading& next);
  void classify_jump(const Reading& next);
  void continue_after_jump();
  void note_jump(const Reading& after, double counts, bool is_by_turns);
  /// [counts] Of the second from where the plate would be at the last rate.
  double deviation(const Reading& from, const Reading& to) const;
  bool has_jumped(const Reading& from, const Reading& to) const;
  /// Whether a reading that the plate may have reached by now is where it would be after the last jump.
  bool goes_on_from_jump(const Reading& next) const;
  bool has_lost_zero(const PlateReading& reading, double receipt) const;
  static bool is_continuous(const clocks::DeviceStamp& from, const PlateReading& reading);

  double counts_per_revolution_;
  double angle_per_count_;  // [rad] negative where counts grow clockwise
  DeviceStamps stamps_;
  TimeSource source_;
  std::deque<Reading> readings_;
  Reading last_;
  double rate_ = 0;      ///< [counts/s] between the last two readings
  double interval_ = 1;  ///< [s] between them
  std::uint64_t taken_ = 0;
  bool zero_is_lost_ = false;
  Before before_reset_;  ///< for a reset that turns out to be none
  std::optional<clocks::DeviceStamp> latest_;
  std::optional<clocks::DeviceStamp> before_;  ///< of another recording, until there is a first reading
  bool zero_is_new_ = false;                   ///< and no piece has reported it
  std::int64_t ahead_ = 0;                     ///< [counts] of the encoder's readings, by jumps
  std::vector<Reading> jumped_;                ///< in a row, each from the place of the one before it
  CountJumps count_jumps_;                     ///< but for its time
  Reading largest_jump_;                       ///< the reading after it
  std::uint64_t impossible_ = 0;
  std::uint64_t after_lost_zero_ = 0;
  std::uint64_t simultaneous_ = 0;
};

}  // namespace crisp::clock
