// SPDX-License-Identifier: BSD-3-Clause
// ROS 2's older bags in SQLite do not hold the definitions of their types. Headers of ROS 1, which begin with
// a number more, always come with one.
#include <array>

#include "grabbers/bag/ros_message_schema.hpp"

namespace crisp {
namespace {

constexpr std::string_view kHeader =
    "\n===\nMSG: std_msgs/Header\nbuiltin_interfaces/Time stamp\nstring frame_id\n";

struct Known {
  std::string_view type, definition;
};

constexpr std::array kKnown = {
    Known{
        "sensor_msgs/LaserScan",
        "Header header\nfloat32 angle_min\nfloat32 angle_max\nfloat32 angle_increment\nfloat32 time_increment\n"
        "float32 scan_time\nfloat32 range_min\nfloat32 range_max\nfloat32[] ranges\nfloat32[] intensities\n"},
    Known{
        "sensor_msgs/MultiEchoLaserScan",
        "Header header\nfloat32 angle_min\nfloat32 angle_max\nfloat32 angle_increment\nfloat32 time_increment\n"
        "float32 scan_time\nfloat32 range_min\nfloat32 range_max\nLaserEcho[] ranges\nLaserEcho[] intensities\n"
        "===\nMSG: sensor_msgs/LaserEcho\nfloat32[] echoes\n"},
    Known{"sensor_msgs/JointState",
          "Header header\nstring[] name\nfloat64[] position\nfloat64[] velocity\nfloat64[] effort\n"},
    Known{"std_msgs/Int16", "int16 data\n"},
    Known{"std_msgs/UInt16", "uint16 data\n"},
    Known{"std_msgs/Int32", "int32 data\n"},
    Known{"std_msgs/UInt32", "uint32 data\n"},
    Known{"std_msgs/Int64", "int64 data\n"},
    Known{"std_msgs/UInt64", "uint64 data\n"},
    Known{"std_msgs/Float32", "float32 data\n"},
    Known{"std_msgs/Float64", "float64 data\n"}};

}  // namespace

std::string known_ros_definition(std::string_view type) {
  for (const auto& known : kKnown) {
    if (known.type == type) return std::string(known.definition) + std::string(kHeader);
  }
  return {};
}

}  // namespace crisp
