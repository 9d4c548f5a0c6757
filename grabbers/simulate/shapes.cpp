// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/simulate/shapes.hpp"

#include <Eigen/Geometry>

namespace crisp::simulate {

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

void place(Scene& scene, double yaw, const Vector3d& by, double scale) {
  Eigen::Matrix3d turn = scale * Eigen::Matrix3d::Identity();
  turn.topLeftCorner<2, 2>() = scale * Eigen::Rotation2Dd(yaw).toRotationMatrix();
  for (auto& surface : scene.surfaces) {
    for (auto& corner : surface.corners) corner = turn * corner + by;
  }
  for (auto& body : scene.bodies) {
    body.shape = placed(body.shape, yaw, by, scale);
    for (auto& point : body.walk.along) point = turn * point;
  }
}

void add(Scene& to, const Scene& more) {
  to.surfaces.insert(to.surfaces.end(), more.surfaces.begin(), more.surfaces.end());
  to.bodies.insert(to.bodies.end(), more.bodies.begin(), more.bodies.end());
}

void look_from(Scene& scene, const Vector3d& position, double yaw) {
  place(scene, 0, -position);
  place(scene, -yaw, Vector3d::Zero());
}

}  // namespace crisp::simulate
