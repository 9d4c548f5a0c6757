// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/simulate/shapes.hpp"

#include <Eigen/Geometry>

namespace crisp {

using Eigen::Vector3d;

Surface rectangle(std::string name, const Vector3d& corner, const Vector3d& a, const Vector3d& b,
                  double reflectance) {
  return {std::move(name), {corner, corner + a, corner + a + b, corner + b}, reflectance};
}

std::vector<Surface> box(const std::string& name, const Vector3d& low, const Vector3d& high,
                         double reflectance) {
  const Vector3d size = high - low;
  const Vector3d x(size.x(), 0, 0);
  const Vector3d y(0, size.y(), 0);
  const Vector3d z(0, 0, size.z());
  return {rectangle(name, low, x, y, reflectance), rectangle(name, low + z, x, y, reflectance),
          rectangle(name, low, x, z, reflectance), rectangle(name, low + y, x, z, reflectance),
          rectangle(name, low, y, z, reflectance), rectangle(name, low + x, y, z, reflectance)};
}

std::vector<Surface> walls(const std::string& name, const std::vector<Eigen::Vector2d>& outline, double low,
                           double high, double reflectance) {
  std::vector<Surface> result;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const Eigen::Vector2d& from = outline[i];
    const Eigen::Vector2d along = outline[(i + 1) % outline.size()] - from;
    result.push_back(rectangle(name, {from.x(), from.y(), low}, {along.x(), along.y(), 0}, {0, 0, high - low},
                               reflectance));
  }
  return result;
}

void turn(std::vector<Surface>& surfaces, const Eigen::Vector2d& centre, double yaw) {
  const Eigen::Rotation2Dd rotation(yaw);
  for (auto& surface : surfaces) {
    for (auto& corner : surface.corners) {
      corner.head<2>() = centre + rotation * (corner.head<2>() - centre);
    }
  }
}

void look_from(std::vector<Surface>& surfaces, const Vector3d& position, double yaw) {
  const Eigen::Rotation2Dd rotation(-yaw);
  for (auto& surface : surfaces) {
    for (auto& corner : surface.corners) {
      corner -= position;
      corner.head<2>() = rotation * corner.head<2>();
    }
  }
}

}  // namespace crisp
