// SPDX-License-Identifier: BSD-3-Clause
#include "tests/end_to_end/room.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>

#include "tests/support/temporary_folder.hpp"

namespace crisp::test {
namespace {

constexpr double kYaw = 0.3;   // [rad]
constexpr double kEdge = 0.1;  // [m] as close to a second wall it is not clear which of them a point is of
const Eigen::Vector3d kPosition(2.3, 2.1, 1.2);
const Eigen::Vector3d kSize(6, 5, 3);

Eigen::Matrix3d turn(double angle) {
  return Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()).toRotationMatrix();
}

/// The direction of the beam that ended at `point`. With α = 0 the scan plane stands on the radius to the
/// laser, τ from the axis: seen from above laser, axis and point make a right angle at the laser. The beam's
/// number determines the side of the radius, left or right.
Eigen::Vector3d direction_of(const Eigen::Vector3d& point, double tau, bool left) {
  const double across = std::sqrt(std::max(0.0, point.head<2>().squaredNorm() - tau * tau));
  const double to_radius = std::atan2(left ? across : -across, tau);
  const Eigen::Vector3d radius = turn(-to_radius) * Eigen::Vector3d(point.x(), point.y(), 0).normalized();
  return (point - tau * radius).normalized();
}

}  // namespace

std::filesystem::path write_room(const std::filesystem::path& file) {
  put_bytes(file,
            "crisp: 1\nname: room\nscanner: {position: [2.3, 2.1, 1.2], yaw: 0.3}\n"
            "surfaces:\n  - {name: room, box: {from: [0, 0, 0], to: [6, 5, 3]}}\n");
  return file;
}

std::vector<Residual> against_room(const Cloud& cloud, const std::vector<double>& tau) {
  constexpr int kDown = 180;  // the vertical beam: reported 45°, in steps of 0.5° from -45°
  std::vector<Residual> residuals;
  for (const Point& each : cloud) {
    const Eigen::Vector3d point = each.getVector3fMap().cast<double>();
    const Eigen::Vector3d seen = turn(kYaw) * point + kPosition;
    std::array<double, 6> distances{};
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      const auto first = 2 * static_cast<std::size_t>(axis);
      distances[first] = seen[axis];
      distances[first + 1] = kSize[axis] - seen[axis];
    }
    const auto nearest = std::min_element(distances.begin(), distances.end());
    const auto close = std::count_if(distances.begin(), distances.end(), [](double d) { return d < kEdge; });
    if (close > 1) continue;
    const auto wall = static_cast<int>(nearest - distances.begin());
    const Eigen::Vector3d beam = turn(kYaw) * direction_of(point, tau[each.laser], each.beam > kDown);
    residuals.push_back({wall, *nearest, std::abs(beam[wall / 2])});
  }
  return residuals;
}

}  // namespace crisp::test
