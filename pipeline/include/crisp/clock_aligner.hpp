// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <crisp/calibration.hpp>
#include <crisp/clock_map.hpp>
#include <crisp/measurements.hpp>
#include <crisp/plate_trajectory.hpp>
#include <crisp/rig.hpp>
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

/// From all that was recorded to measurements: for each stretch of time first the plate's trajectory, then
/// all measurements in it, one scan after the other in the order of their beginnings over all lasers.
///
/// Stamps are fitted window by window (see WindowedClockFit), and what lies between the middles of two
/// windows is handed out as soon as the second is fitted, so that memory holds two windows and not the
/// recording. A recording shorter than one and a half windows has one line and is handed out in one piece.
/// The automatic window is 60 s, and doubles, up to 240 s, while delays are so rough that they leave a line
/// less certain than the drift over the window.
///
/// After a pause of all devices (kPause) another recording begins, which has nothing in common with the one
/// before it but the epoch. Where the devices' clocks ran on, the hub's clock was set forward: that is
/// reported as its step, taken out of all receipts after it, and the recording goes on.
class ClockAligner final : public Aligner {
 public:
  /// @param rig   whose lasers and plate the scans and readings come from
  /// @param sink  receives the results while the recording is read
  /// @throws Error  if the rig gives no counts a revolution
  ClockAligner(const Rig& rig, const AlignmentSettings& settings, AlignmentSink sink);
  ~ClockAligner() override;

  void add(std::shared_ptr<const Scan> scan) override;
  /// @throws Error if the plate's clock cannot be used at all
  void add(const PlateReading& reading) override;
  AlignmentReport finish() override;

 private:
  class Windows;
  std::unique_ptr<Windows> windows_;
};

/// How stamps become hub times while they come in.
struct OnlineSettings {
  double window = 60;          ///< [s] of stamps that a clock's line is fitted to
  double warm_up = 0.5;        ///< [s] of stamps of a device before its line is used
  double margin = 0.06;        ///< [s] by which a trajectory covers more than its scan, as far as it is known
  double plate_timeout = 0.2;  ///< [s] for the encoder readings, after which a scan goes without them
  double least_lag = 0;        ///< [s] of any laser behind the plate: the least η, and
  double greatest_lag =
      0;                  ///< [s] the greatest, so that the readings that a scan is placed by are waited for
  double lag_margin = 0;  ///< [s] margin of lags beyond the calibration
};

/// Default number of stamps on either side that smooth the mirror's motion: of those so far.
inline constexpr unsigned kOnlineMirror = 5;

/// The settings with the lags of a calibration's lasers, and the margin.
OnlineSettings with_lags(OnlineSettings settings, const Calibration& calibration);

/// From scans and readings in the order of receipt to measurements, each scan as soon as the encoder readings
/// cover it. A device's clock is the line below its stamps of the last minute; what was handed out is not
/// corrected when the line becomes better known. So what is handed out depends on the items alone, and their
/// times of receipt: a recording of them gives the same again.
class OnlineAligner final : public Aligner {
 public:
  /// @param alignment  `find`, `drift`, `source`, `plate` and `mirror_half_width` count here
  OnlineAligner(const Rig& rig, const AlignmentSettings& alignment, const OnlineSettings& online,
                AlignmentSink sink);
  ~OnlineAligner() override;

  void add(std::shared_ptr<const Scan> scan) override;
  /// @throws Error if the plate's clock cannot be used at all
  void add(const PlateReading& reading) override;
  AlignmentReport finish() override;

  /// From now on it waits for what these lasers' lags need.
  void set_lags(const Calibration& calibration);
  /// The devices' clocks as they are known now: the lasers in the rig's order, then the plate.
  std::vector<DeviceReport> devices() const;
  double now() const;  ///< [s since the epoch] latest receipt
  /// Scans that wait for the plate.
  std::size_t waiting() const;

 private:
  class Queue;
  std::unique_ptr<Queue> queue_;
};

}  // namespace crisp
