// SPDX-License-Identifier: BSD-3-Clause
#include "tests/end_to_end/scene_distance.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace crisp::test {
namespace {

double to_segment(const Eigen::Vector3d& x, const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  const double along = std::clamp((x - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
  return (x - a - along * (b - a)).norm();
}

/// Whether the point's projection lies within the corners, which may go round either way (crossing number).
bool is_above(const Eigen::Vector3d& x, const Surface& surface, const Eigen::Vector3d& normal) {
  const Eigen::Vector3d u = (surface.corners[1] - surface.corners[0]).normalized();
  const Eigen::Vector3d v = normal.cross(u);
  bool inside = false;
  const auto& corners = surface.corners;
  for (std::size_t i = 0, j = corners.size() - 1; i < corners.size(); j = i++) {
    const double ui = u.dot(corners[i] - x), vi = v.dot(corners[i] - x);
    const double uj = u.dot(corners[j] - x), vj = v.dot(corners[j] - x);
    if ((vi > 0) != (vj > 0) && ui + (uj - ui) * vi / (vi - vj) > 0) inside = !inside;
  }
  return inside;
}

double to_surface(const Eigen::Vector3d& x, const Surface& surface) {
  const auto& corners = surface.corners;
  const Eigen::Vector3d normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]).normalized();
  if (is_above(x, surface, normal)) return std::abs(normal.dot(x - corners[0]));
  double nearest = to_segment(x, corners.back(), corners.front());
  for (std::size_t i = 1; i < corners.size(); ++i) {
    nearest = std::min(nearest, to_segment(x, corners[i - 1], corners[i]));
  }
  return nearest;
}

}  // namespace

double rms_distance(const Cloud& cloud, const Scene& scene, std::size_t every, double most) {
  double sum = 0;
  std::size_t n = 0;
  for (std::size_t i = 0; i < cloud.size(); i += every, ++n) {
    const Eigen::Vector3d x = cloud[i].getVector3fMap().cast<double>();
    double nearest = most;
    for (const Surface& surface : scene.surfaces) nearest = std::min(nearest, to_surface(x, surface));
    sum += nearest * nearest;
  }
  return std::sqrt(sum / static_cast<double>(n));
}

}  // namespace crisp::test
