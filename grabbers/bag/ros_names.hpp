// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>

namespace crisp::bag {

/// The name of a type as ROS 1 and ROS 2 both have it: "sensor_msgs/msg/LaserScan" → "sensor_msgs/LaserScan".
inline std::string plain_ros_type(std::string_view name) {
  constexpr std::string_view kMsg = "/msg/";
  std::string plain(name);
  if (const auto at = plain.find(kMsg); at != std::string::npos) plain.replace(at, kMsg.size(), "/");
  return plain;
}

}  // namespace crisp::bag
