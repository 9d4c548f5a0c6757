// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <crisp/rig.hpp>
#include <crisp/scan.hpp>

#include "grabbers/bag/ros_message_schema.hpp"

namespace crisp::bag {

/// A sensor_msgs/LaserScan or MultiEchoLaserScan.
struct ScanMessage {
  std::int64_t stamp_ns = 0;  ///< [ns] of its header: when beam 0 was fired
  double angle_min = 0;       ///< [rad]
  double angle_increment = 0;
  double time_increment = 0;  ///< [s]
  double scan_time = 0;       ///< [s]
  std::vector<Echo>
      echoes;  ///< ranges outside of [range_min, range_max], and those that are no numbers, are 0
};

/// Reads scans out of messages that are, or hold, a LaserScan or MultiEchoLaserScan.
class ScanDecoder {
 public:
  /// @return nothing if such messages hold no scan
  static std::optional<ScanDecoder> of(const BagConnection& connection);

  /// @throws BagDamage if the message does not match its type, or is an impossible scan
  ScanMessage decode(std::string_view message) const;

 private:
  ScanDecoder(RosMessageSchema layout, RosEncoding encoding, std::string prefix, bool multi_echo);

  RosMessageSchema layout_;
  RosEncoding encoding_;
  bool multi_echo_;
  std::size_t sec_, nanosec_, angle_min_, angle_increment_, time_increment_, scan_time_, range_min_,
      range_max_, ranges_, intensities_;
};

/// One encoder reading's angle.
struct AngleMessage {
  std::optional<std::int64_t> stamp_ns;           ///< [ns] of its header, if it has one
  double angle = 0;                               ///< [rad] as the device counts it
  std::optional<std::array<double, 4>> rotation;  ///< in its place: x, y, z, w
};

/// Reads the plate's angle out of messages: of a JointState, of a frame of tf, or any field of another
/// message, a number or a quaternion.
class AngleDecoder {
 public:
  /// @return nothing if such messages hold no angle
  /// @throws Error if the rig names a field that they do not have
  static std::optional<AngleDecoder> of(const BagConnection& connection, const RigPlate& plate);

  /// @return nothing if the message does not contain the joint
  /// @throws BagDamage if it does not match its type, or an angle is no number
  std::optional<AngleMessage> decode(std::string_view message) const;

 private:
  bool find_rotation(const BagConnection& connection, const RigPlate& plate);
  std::optional<AngleMessage> decode_rotation(std::string_view message) const;

  RosMessageSchema layout_;
  RosEncoding encoding_ = RosEncoding::other;
  std::optional<std::size_t> sec_, nanosec_;
  std::optional<std::size_t> joints_;  ///< names of a JointState
  std::string joint_;                  ///< empty: the only one
  std::size_t value_ = 0;
  double scale_ = 1;                       ///< [rad] of one
  std::optional<std::size_t> quaternion_;  ///< its x: y, z and w follow
  std::optional<std::size_t> frames_;      ///< names of the frames of tf: joint_ is the one
};

}  // namespace crisp::bag
