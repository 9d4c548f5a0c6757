// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <crisp/clock_map.hpp>
#include <crisp/measurements.hpp>
#include <crisp/plate_trajectory.hpp>
#include <crisp/scan.hpp>

namespace crisp {

/// Source of the measurements' hub times.
enum class TimeSource {
  clock,    ///< the device's time, through the map of its clock
  receipt,  ///< the hub's receipt time, as it is
};

/// How readings become the motion between them.
struct PlateMotionSettings {
  double max_gap = 0.1;                  ///< [s] longest silence of the encoder to interpolate across
  double smoothing = kEncoderSmoothing;  ///< [s] see between_steps()
};

/// How stamps become hub times.
struct AlignmentSettings {
  TimeSource source = TimeSource::clock;  ///< where the measurements' hub times come from
  double drift = 200e-6 / 3600;           ///< [1/s] largest change of a clock's rate in a second
  std::optional<double> window;  ///< [s] stretch of stamps that one line is fitted to; none: automatic
  double margin = 0.25;          ///< [s] by which a trajectory covers more than its measurements' times
  PlateMotionSettings plate;     ///< how readings become the motion between them
  std::optional<unsigned> mirror_half_width;  ///< stamps on either side that smooth the mirror's motion
};

/// A jump of a device's clock, or of its link's shortest delay.
struct StampStep {
  double at = 0;  ///< [s since the epoch] receipt of the first stamp after it
  double by = 0;  ///< [s] forwards, or longer
};

/// A time in which nothing came from a device.
struct SilentTime {
  double begin = 0;     ///< [s since the epoch] receipt of the last item before it
  double duration = 0;  ///< [s]
};

/// Counts of one device's telegrams or readings.
struct DeviceReport {
  std::string device;                  ///< the rig's name of it
  std::optional<ClockMap> clock;       ///< nothing where no stamp was of use
  std::size_t stamps = 0;              ///< that its clock is fitted to
  std::uint64_t received = 0;          ///< telegrams or readings, of use or not
  std::uint64_t lost = 0;              ///< by the gaps of its counter; 0 where it has none
  std::uint64_t repeated = 0;          ///< came twice: left out
  std::uint64_t late = 0;              ///< came after later ones: left out
  std::uint64_t standing = 0;          ///< carry the stamp of their predecessor, but another count: left out
  std::uint64_t damaged = 0;           ///< with times that fit nothing before or after: left out
  std::uint64_t resets = 0;            ///< of its clock
  double standstill = 0;               ///< [s] for how long at most its clock stood still
  bool by_receipt = false;             ///< its clock stands still: receipts count instead
  std::vector<SilentTime> silences;    ///< of 1 s and more, in their order; at most about 1000
  std::vector<StampStep> clock_steps;  ///< by how much its clock jumped: forwards
  std::vector<StampStep> delay_steps;  ///< by how much its shortest delay grew

  /// Number of received telegrams that were unusable.
  std::uint64_t left_out() const { return repeated + late + standing + damaged; }
};

/// Report of an alignment, for people and for the summary.
struct AlignmentReport {
  std::vector<DeviceReport>
      devices;  ///< the lasers in the order of the rig, then the plate; of each recording
  std::map<std::string, std::uint64_t> counts;  ///< losses and other events, by name
  std::vector<std::string> warnings;            ///< what a person should know
  std::vector<std::string> caveats;             ///< why the times cannot be trusted
  std::vector<StampStep> hub_steps;             ///< by how much the hub's clock was set: forwards
  double hub_deviation = 0;                     ///< [s] by how much at most it deviated from a steady one

  /// Adds what was done of another recording.
  void append(AlignmentReport other);
};

/// Receives an alignment's results: the plate's trajectory over a time first, then measurements in it.
struct AlignmentSink {
  std::function<void(PlateTrajectory)> trajectory;  ///< receives φ(t) over the measurements that come next
  std::function<void(std::shared_ptr<const Measurements>)>
      measurements;  ///< receives the measurements of one scan
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
  /// @throws Error if the plate's clock cannot be used at all
  virtual void add(const PlateReading& reading) = 0;
  /// Hands out all that is left.
  /// @throws Error if there was no scan of any laser, or no encoder reading
  virtual AlignmentReport finish() = 0;
};

}  // namespace crisp
