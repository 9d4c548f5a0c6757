// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "pipeline/data/measurements.hpp"
#include "pipeline/data/plate_trajectory.hpp"
#include "pipeline/data/rig.hpp"
#include "pipeline/data/scan.hpp"
#include "plugins/clock/laser_track.hpp"
#include "plugins/clock/plate_track.hpp"

namespace crisp {

/// How stamps become hub times.
struct AlignmentSettings {
  LineFinder find = line_by_convex_hull;
  TimeSource source = TimeSource::clock;
  double drift = 200e-6 / 3600;  ///< [1/s] largest change of a clock's rate in a second
  std::optional<double> window;  ///< [s] stretch of stamps that one line is fitted to; none: automatic
  double margin = 0.25;          ///< [s] by which a trajectory covers more than its measurements' times
  PlateMotionSettings plate;
  std::optional<unsigned> mirror_half_width;  ///< stamps on either side that smooth the mirror's motion
};

/// What an alignment did, for people and for the summary.
struct AlignmentReport {
  std::vector<DeviceReport> devices;  ///< the lasers in the order of the rig, then the plate
  std::map<std::string, std::uint64_t> counts;
  std::vector<std::string> warnings;
  std::vector<std::string> doubts;  ///< why the times cannot be trusted
};

/// Where an alignment puts what it makes: for each stretch of time first the plate's trajectory, then all
/// measurements in it, one scan after the other in the order of their beginnings over all lasers.
struct AlignmentSink {
  std::function<void(PlateTrajectory)> trajectory;
  std::function<void(Measurements)> measurements;
};

/// From scans and readings in the order of receipt to measurements and the plate's trajectory on the hub's
/// clock. The epoch is the whole second before the first receipt.
///
/// Stamps are fitted window by window (see FittedClock), and what lies between the middles of two windows is
/// handed out as soon as the second is fitted, so that memory holds two windows and not the recording. A
/// recording shorter than one and a half windows has one line and is handed out in one piece. The automatic
/// window is 60 s, and doubles, up to 240 s, while delays are so rough that they leave a line less certain
/// than the drift over the window.
class ClockAligner {
 public:
  ClockAligner(const Rig& rig, const AlignmentSettings& settings, AlignmentSink sink);

  /// @throws Error if a device's clock cannot be used at all
  void add(std::shared_ptr<const Scan> scan);
  void add(const PlateReading& reading);
  /// Hands out all that is left.
  /// @throws Error if there was no scan of any laser, or no reading of the plate
  AlignmentReport finish();

 private:
  double arrive(std::int64_t receipt_ns);
  void advance_windows();
  bool is_too_short() const;
  void settle(double begin, double end);
  void hand_out(double limit);
  bool idle() const;
  void refuse_if_missing() const;
  AlignmentReport report() const;

  AlignmentSettings settings_;
  AlignmentSink sink_;
  std::vector<LaserTrack> lasers_;
  PlateTrack plate_;
  std::int64_t epoch_ns_ = 0;
  bool begun_ = false;
  double now_ = 0;    ///< [s since the epoch] latest receipt
  double begin_ = 0;  ///< [s since the epoch] of the window that is being filled
  double length_;     ///< [s] of it
  std::uint64_t unknown_lasers_ = 0;
  std::uint64_t back_in_time_ = 0;
};

}  // namespace crisp
