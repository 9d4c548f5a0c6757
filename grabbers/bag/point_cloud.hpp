// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "grabbers/bag/ros_message_schema.hpp"

namespace crisp::bag {

/// One point of a laser in the laser's own frame.
struct CloudPoint {
  float range = 0;       ///< [m]
  double azimuth = 0;    ///< [rad] from x to y
  double elevation = 0;  ///< [rad] above the plane z = 0
  double time = 0;       ///< [s] after the message's stamp
  float remission = 0;   ///< 0 where there is none
  int ring = -1;         ///< number of the laser in a 3D laser; −1: none is stated
};

/// A sensor_msgs/PointCloud2 of a laser.
struct PointMessage {
  std::int64_t stamp_ns = 0;       ///< [ns] of its header
  std::vector<CloudPoint> points;  ///< in the order of their times
  bool timed = false;              ///< whether each has a time of its own
};

/// Reads points out of PointCloud2 messages. Fields are x, y, z, and where they are there a time (`t`,
/// `time`, `timestamp`: whole numbers in ns, others in s, after the stamp or since 1970), an intensity and a
/// ring.
class PointDecoder {
 public:
  /// @return nothing if such messages are no PointCloud2
  static std::optional<PointDecoder> of(const BagConnection& connection);

  /// @throws BagDamage if the message does not match its type
  PointMessage decode(std::string_view message) const;

 private:
  RosMessageSchema layout_;
  RosEncoding encoding_ = RosEncoding::other;
};

}  // namespace crisp::bag
