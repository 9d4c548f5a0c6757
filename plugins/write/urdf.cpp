// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/write/urdf.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace crisp::write {
namespace {

/// Roll, pitch and yaw about the fixed axes x, y, z, as URDF has them [rad].
Eigen::Vector3d roll_pitch_yaw(const Eigen::Matrix3d& rotation) {
  constexpr double kGimbalLock = 1 - 1e-12;
  const double sine = std::clamp(-rotation(2, 0), -1.0, 1.0);
  if (std::abs(sine) > kGimbalLock) {
    return {0, std::copysign(std::numbers::pi / 2, sine), std::atan2(-rotation(0, 1), rotation(1, 1))};
  }
  return {std::atan2(rotation(2, 1), rotation(2, 2)), std::asin(sine),
          std::atan2(rotation(1, 0), rotation(0, 0))};
}

/// From the laser's frame to the plate's: Rz(λ + α) Ry(π/2) of equation (2), and Rz(−mount) from reported
/// angles to θ.
Eigen::Matrix3d orientation_of(const LaserCalibration& laser, double mount) {
  using Eigen::AngleAxisd;
  using Eigen::Vector3d;
  return (AngleAxisd(laser.lambda.value + laser.alpha.value, Vector3d::UnitZ()) *
          AngleAxisd(std::numbers::pi / 2, Vector3d::UnitY()) * AngleAxisd(-mount, Vector3d::UnitZ()))
      .toRotationMatrix();
}

double mount_of(const std::string& laser, const Rig& rig) {
  const auto found = std::ranges::find(rig.lasers, laser, &RigLaser::name);
  return found == rig.lasers.end() ? 0 : found->mount;
}

/// Properties of a laser that URDF cannot hold.
std::string lost_of(const LaserCalibration& laser) {
  std::string lost =
      fmt::format("    <!-- lag of the plate behind {}: {:.9g} s", laser.name, laser.eta.value);
  for (const auto& term : laser.terms) lost += "; not in URDF: " + term.term;
  return lost + " -->\n";
}

}  // namespace

std::string to_urdf(const Calibration& calibration, const Rig& rig) {
  std::string urdf =
      "  <link name=\"plate\"/>\n"
      "  <joint name=\"plate_joint\" type=\"continuous\">\n"
      "    <parent link=\"base_link\"/>\n"
      "    <child link=\"plate\"/>\n"
      "    <axis xyz=\"0 0 1\"/>\n"
      "  </joint>";
  for (const auto& laser : calibration.lasers) {
    const double mount = mount_of(laser.name, rig);
    const Eigen::Vector3d rpy = roll_pitch_yaw(orientation_of(laser, mount));
    const double x = laser.tau.value * std::cos(laser.lambda.value);
    const double y = laser.tau.value * std::sin(laser.lambda.value);
    urdf += fmt::format(
        "\n  <link name=\"{0}\"/>\n"
        "  <joint name=\"{0}_joint\" type=\"fixed\">\n"
        "{1}    <!-- ros2 run tf2_ros static_transform_publisher {2:.9f} {3:.9f} 0 {6:.9f} {5:.9f} {4:.9f} plate {0} -->\n"
        "    <parent link=\"plate\"/>\n"
        "    <child link=\"{0}\"/>\n"
        "    <origin xyz=\"{2:.9f} {3:.9f} 0\" rpy=\"{4:.9f} {5:.9f} {6:.9f}\"/>\n"
        "  </joint>",
        laser.name, lost_of(laser), x, y, rpy.x(), rpy.y(), rpy.z());
  }
  return urdf;
}

}  // namespace crisp::write
