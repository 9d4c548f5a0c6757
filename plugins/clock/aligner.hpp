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
#include "pipeline/data/pool.hpp"
#include "pipeline/data/rig.hpp"
#include "pipeline/data/scan.hpp"
#include "plugins/clock/laser_timing.hpp"
#include "plugins/clock/plate_timing.hpp"

namespace crisp {

/// How stamps become hub times.
struct AlignmentSettings {
  TimeSource source = TimeSource::clock;
  double drift = 200e-6 / 3600;  ///< [1/s] largest change of a clock's rate in a second
  std::optional<double> window;  ///< [s] stretch of stamps that one line is fitted to; none: automatic
  double margin = 0.25;          ///< [s] by which a trajectory covers more than its measurements' times
  PlateMotionSettings plate;
  std::optional<unsigned> mirror_half_width;  ///< stamps on either side that smooth the mirror's motion
};

/// Report of an alignment, for people and for the summary.
struct AlignmentReport {
  std::vector<DeviceReport>
      devices;  ///< the lasers in the order of the rig, then the plate; of each recording
  std::map<std::string, std::uint64_t> counts;
  std::vector<std::string> warnings;
  std::vector<std::string> caveats;  ///< why the times cannot be trusted
  std::vector<StampStep> hub_steps;  ///< by how much the hub's clock was set: forwards
  double hub_deviation = 0;          ///< [s] by how much at most it deviated from a steady one

  /// Adds what was done of another recording.
  void append(AlignmentReport other);
};

/// Receives an alignment's results: the plate's trajectory over a time first, then measurements in it.
struct AlignmentSink {
  std::function<void(PlateTrajectory)> trajectory;
  std::function<void(std::shared_ptr<const Measurements>)> measurements;
};

/// From scans and readings in the order of receipt to measurements and the plate's trajectory on the hub's
/// clock. The epoch is that of epoch_of_run().
class Aligner {
 public:
  Aligner() = default;
  Aligner(const Aligner&) = delete;
  Aligner& operator=(const Aligner&) = delete;
  virtual ~Aligner() = default;

  /// @throws Error if a device's clock cannot be used at all
  virtual void add(std::shared_ptr<const Scan> scan) = 0;
  virtual void add(const PlateReading& reading) = 0;
  /// Hands out all that is left.
  /// @throws Error if there was no scan of any laser, or no encoder reading
  virtual AlignmentReport finish() = 0;
};

/// An aligner's tracks of a rig's devices.
class HubTimings {
 public:
  HubTimings(const Rig& rig, const AlignmentSettings& settings);

  /// Notes that something was received. @return [s since the epoch] when
  double arrive(std::int64_t receipt_ns);
  /// [s] How long nothing had come from any device when this is received.
  double pause_before(std::int64_t receipt_ns) const;
  /// Forgets all but the epoch and where the plate was: what comes now is of another recording.
  void begin_anew();
  /// The track that a scan belongs to; nullptr, and counted, if the rig has no such laser.
  LaserTiming* track_of(const Scan& scan);

  std::vector<LaserTiming>& lasers() { return lasers_; }
  const std::vector<LaserTiming>& lasers() const { return lasers_; }
  /// Measurements of a scan, on the hub's clock.
  std::shared_ptr<const Measurements> measurements_of(const TimedScan& scan);
  PlateTiming& plate() { return plate_; }
  const PlateTiming& plate() const { return plate_; }
  std::int64_t epoch_ns() const { return epoch_ns_; }
  double now() const { return now_; }  ///< [s since the epoch] latest receipt

  std::uint64_t scans_received() const;  ///< of use or not
  bool has_scans() const;                ///< of any laser
  bool has_readings() const;             ///< of the plate, two or more
  /// @throws Error as Aligner::finish()
  void refuse_if_missing() const;
  void finish_clocks();
  std::vector<DeviceReport> reports() const;
  AlignmentReport report() const;

 private:
  Rig rig_;
  AlignmentSettings settings_;
  std::vector<LaserTiming> lasers_;
  PlateTiming plate_;
  Pool<Measurements> measurements_;
  std::int64_t epoch_ns_ = 0;
  bool begun_ = false;
  std::optional<double> begin_;  ///< [s since the epoch] of the present recording
  double now_ = 0;
  std::uint64_t unknown_lasers_ = 0;
  std::uint64_t back_in_time_ = 0;
};

}  // namespace crisp
