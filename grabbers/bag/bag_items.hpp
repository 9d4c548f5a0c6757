// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <crisp/measurements.hpp>
#include <crisp/plate_trajectory.hpp>

#include "grabbers/bag/joint_angle.hpp"
#include "grabbers/bag/point_cones.hpp"
#include "grabbers/bag/ros_scan_messages.hpp"
#include "grabbers/devices/rotating_head.hpp"
#include "grabbers/table/actuator_angles.hpp"

namespace crisp::bag {

/// [s] until all beams of a scan were fired.
double duration_of_beams(const ScanMessage& message);

/// Converts a bag's messages: scans and readings with the header's stamp as their
/// device's time and the receipt as the hub's, for a clock stage; and measurements with the plate's angles on
/// the headers' own time, where laser and plate were stamped by one clock.
class BagItems {
 public:
  /// @param max_gap  [s] longest silence of the angles to interpolate across
  BagItems(Rig rig, double max_gap)
      : rig_(std::move(rig)), max_gap_(max_gap), angles_(rig_.plate), cones_(rig_) {}

  /// @return nothing for a scan that is earlier than the one before or of its time, which is counted
  std::shared_ptr<const Scan> add(ScanMessage message, std::int64_t receipt_ns, std::uint16_t laser);
  /// Adds the points of one laser that sweeps a plane.
  /// @return whether the points are later than the scan before of this laser; else they are counted
  bool add(const PointMessage& message, std::uint16_t laser);
  /// Adds the points of all lasers of a rotating head, with the head's azimuths.
  /// @return likewise
  /// @throws Error if the points have no times, or are not those of a head
  bool add_head(const PointMessage& message, std::span<const std::uint16_t> lasers);
  /// @return nothing for an angle that is earlier than the one before or of its time, which is counted
  /// @param lasts  [s] how long the plate stands at that angle; 0 where it moves
  std::optional<PlateReading> add(const AngleMessage& message, std::int64_t receipt_ns, double lasts = 0);

  /// The 3D laser whose azimuths are the plate's angles; nullptr if the bag had none so far.
  devices::RotatingHead* head() { return head_ ? &*head_ : nullptr; }
  /// @throws Error if most points of a laser, or azimuths of the head, cannot be of it
  void check() const;

  bool has_trajectory() const { return angles_.size() > 1; }
  PlateTrajectory trajectory() const { return angles_.trajectory(*epoch_ns_, max_gap_); }
  /// Calls `use` with the measurements of each scan so far, in their order.
  void for_each_measured(const std::function<void(std::shared_ptr<const Measurements>)>& use) const;

  /// All that was left out, by its reason.
  std::map<std::string, std::uint64_t> losses() const;

 private:
  struct Stamped {
    std::shared_ptr<const Scan> scan;
    double time;                                 ///< [s since the epoch] of beam 0
    std::shared_ptr<const Measurements> points;  ///< in place of a scan
  };
  /// @param begin  [s since the epoch] of the message
  Measurements beams_of(const std::vector<LaserPoint>& points, double begin) const;
  std::shared_ptr<const Measurements> measured(const Stamped& stamped) const;
  /// [µs] since the epoch, which the first stamp makes.
  std::int64_t device_us(std::int64_t stamp_ns) const;
  double seconds(std::int64_t stamp_ns) const;
  /// Whether a stamp is behind the one before of its device.
  bool advance(std::optional<std::int64_t>& last, std::int64_t stamp_ns, const char* what);

  Rig rig_;
  double max_gap_;
  std::optional<std::int64_t> epoch_ns_;
  JointRotation rotation_;
  table::ActuatorAngles angles_;
  PointCones cones_;
  std::optional<devices::RotatingHead> head_;
  std::uint16_t readings_ = 0;  ///< wraps, as a device's counter does
  std::map<std::uint16_t, std::uint16_t> counters_;
  std::map<std::uint16_t, std::optional<std::int64_t>> last_scan_ns_;
  std::optional<std::int64_t> last_angle_ns_;
  std::vector<Stamped> scans_;
  std::map<std::string, std::uint64_t> losses_;
};

}  // namespace crisp::bag
