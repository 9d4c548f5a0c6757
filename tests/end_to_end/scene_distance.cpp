// SPDX-License-Identifier: BSD-3-Clause
#include "tests/end_to_end/scene_distance.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace crisp::test {
namespace {

using namespace crisp::simulate;

using Point3 = Eigen::Vector3d;

/// From the nearest point of a segment to x.
Point3 from_segment(const Point3& x, const Point3& a, const Point3& b) {
  const double along = std::clamp((x - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
  return x - a - along * (b - a);
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

/// From the nearest point of a surface to x.
Point3 from_surface(const Point3& x, const Surface& surface) {
  const auto& corners = surface.corners;
  const Point3 normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]).normalized();
  if (is_above(x, surface, normal)) return normal.dot(x - corners[0]) * normal;
  Point3 nearest = from_segment(x, corners.back(), corners.front());
  for (std::size_t i = 1; i < corners.size(); ++i) {
    const Point3 other = from_segment(x, corners[i - 1], corners[i]);
    if (other.squaredNorm() < nearest.squaredNorm()) nearest = other;
  }
  return nearest;
}

Point3 from_scene(const Point3& x, const Scene& scene) {
  Point3 nearest = Point3::Constant(1e9);
  for (const Surface& surface : scene.surfaces) {
    const Point3 other = from_surface(x, surface);
    if (other.squaredNorm() < nearest.squaredNorm()) nearest = other;
  }
  return nearest;
}

}  // namespace

SceneDistance distance_to(const Scene& scene, const Cloud& cloud, std::size_t every, double most) {
  SceneDistance result;
  constexpr int kSteps = 3;  // of Gauss and Newton, in the turn
  for (int step = 0; step <= kSteps; ++step) {
    const Eigen::AngleAxisd turn(result.turn, Point3::UnitZ());
    double squares = 0, slope = 0, curvature = 0;
    std::size_t n = 0;
    for (std::size_t i = 0; i < cloud.size(); i += every, ++n) {
      const Point3 x = turn * cloud[i].getVector3fMap().cast<double>();
      const Point3 away = from_scene(x, scene);
      const double distance = away.norm();
      squares += std::min(distance, most) * std::min(distance, most);
      if (distance == 0 || distance > most) continue;
      const double moves = away.dot(Point3::UnitZ().cross(x)) / distance;
      slope += moves * distance;
      curvature += moves * moves;
    }
    result.turned = std::sqrt(squares / static_cast<double>(n));
    if (step == 0) result.as_it_is = result.turned;
    if (step < kSteps) result.turn -= slope / curvature;
  }
  return result;
}

}  // namespace crisp::test
