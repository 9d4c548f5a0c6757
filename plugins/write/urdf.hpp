// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include <crisp/calibration.hpp>
#include <crisp/rig.hpp>

namespace crisp::write {

/// A calibration as a piece of URDF for ROS, with a link for the plate and each laser, and the same
/// transforms as commands of tf2. A laser's frame has its reported angle 0 along x and grows
/// counter-clockwise about z, as sensor_msgs/LaserScan wants it.
/// @param rig  for the lasers' mounts
std::string to_urdf(const Calibration& calibration, const Rig& rig);

}  // namespace crisp::write
