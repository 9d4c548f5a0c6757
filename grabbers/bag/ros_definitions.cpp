// SPDX-License-Identifier: BSD-3-Clause
// ROS 2's older bags in SQLite do not hold the definitions of their types. Headers of ROS 1, which begin with
// a number more, always come with one.
#include <array>

#include "grabbers/bag/ros_message_schema.hpp"

namespace crisp::bag {
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
    Known{
        "sensor_msgs/PointCloud2",
        "Header header\nuint32 height\nuint32 width\nPointField[] fields\nbool is_bigendian\nuint32 point_step\n"
        "uint32 row_step\nuint8[] data\nbool is_dense\n"
        "===\nMSG: sensor_msgs/PointField\nstring name\nuint32 offset\nuint8 datatype\nuint32 count\n"},
    Known{"sensor_msgs/JointState",
          "Header header\nstring[] name\nfloat64[] position\nfloat64[] velocity\nfloat64[] effort\n"},
    Known{
        "tf2_msgs/TFMessage",
        "geometry_msgs/TransformStamped[] transforms\n"
        "===\nMSG: geometry_msgs/TransformStamped\nHeader header\nstring child_frame_id\nTransform transform\n"
        "===\nMSG: geometry_msgs/Transform\nVector3 translation\nQuaternion rotation\n"
        "===\nMSG: geometry_msgs/Vector3\nfloat64 x\nfloat64 y\nfloat64 z\n"
        "===\nMSG: geometry_msgs/Quaternion\nfloat64 x\nfloat64 y\nfloat64 z\nfloat64 w\n"},
    Known{"nav_msgs/Odometry",
          "Header header\nstring child_frame_id\ngeometry_msgs/PoseWithCovariance pose\n"
          "geometry_msgs/TwistWithCovariance twist\n"
          "===\nMSG: geometry_msgs/PoseWithCovariance\nPose pose\nfloat64[36] covariance\n"
          "===\nMSG: geometry_msgs/Pose\nPoint position\nQuaternion orientation\n"
          "===\nMSG: geometry_msgs/Point\nfloat64 x\nfloat64 y\nfloat64 z\n"
          "===\nMSG: geometry_msgs/Quaternion\nfloat64 x\nfloat64 y\nfloat64 z\nfloat64 w\n"
          "===\nMSG: geometry_msgs/TwistWithCovariance\nTwist twist\nfloat64[36] covariance\n"
          "===\nMSG: geometry_msgs/Twist\nVector3 linear\nVector3 angular\n"
          "===\nMSG: geometry_msgs/Vector3\nfloat64 x\nfloat64 y\nfloat64 z\n"},
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

}  // namespace crisp::bag
