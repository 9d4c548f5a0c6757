// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <optional>
#include <string>
#include <variant>

namespace crisp::simulate {

struct Ray {
  Eigen::Vector3d origin;     ///< [m]
  Eigen::Vector3d direction;  ///< unit vector
};

/// A round bar with flat ends.
struct Cylinder {
  Eigen::Vector3d from;  ///< [m] middle of one end
  Eigen::Vector3d to;    ///< [m] and of the other
  double radius = 0;     ///< [m]
};

/// An ellipsoid with one axis upright; a sphere where all are the same.
struct Ellipsoid {
  Eigen::Vector3d middle;  ///< [m]
  Eigen::Vector3d radii;   ///< [m] along its own x, its own y, and the vertical
  double yaw = 0;          ///< [rad] of its own x
};

/// A box that stands upright.
struct Block {
  Eigen::Vector3d middle;  ///< [m]
  Eigen::Vector3d half;    ///< [m] half of its sides along its own x, its own y, and the vertical
  double yaw = 0;          ///< [rad] of its own x
};

using Solid = std::variant<Cylinder, Ellipsoid, Block>;

/// The part of a ray's line inside a solid.
struct Passage {
  double in = 0;   ///< [m] along the ray, negative where it begins before the ray does
  double out = 0;  ///< [m]
};

/// All solids here are convex: a line goes through once at most.
std::optional<Passage> passage(const Solid& solid, const Ray& ray);

/// The unit normal, outwards, at a point of the solid's surface.
Eigen::Vector3d normal_at(const Solid& solid, const Eigen::Vector3d& point);

/// Distance [m] of a point to the solid's surface, inside and outside.
double distance_to_surface(const Solid& solid, const Eigen::Vector3d& point);

bool is_inside(const Solid& solid, const Eigen::Vector3d& point);

Eigen::AlignedBox3d bounds(const Solid& solid);

/// The same solid elsewhere: turned by `yaw` [rad] about the vertical through the origin, made larger by
/// `scale`, then moved by `by` [m].
Solid placed(const Solid& solid, double yaw, const Eigen::Vector3d& by, double scale = 1);

/// @throws Error  if the solid has no volume; `name` is its name in the message
void check(const Solid& solid, const std::string& name);

}  // namespace crisp::simulate
