// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "grabbers/simulate/scene.hpp"

namespace crisp::simulate {

/// The rectangle between `corner`, `corner + a`, `corner + a + b` and `corner + b` [m].
Surface rectangle(std::string name, const Eigen::Vector3d& corner, const Eigen::Vector3d& a,
                  const Eigen::Vector3d& b, double reflectance);

/// The six faces of a box with edges along the axes, from corner `low` to corner `high` [m].
std::vector<Surface> box(const std::string& name, const Eigen::Vector3d& low, const Eigen::Vector3d& high,
                         double reflectance);

/// An upright prism over a polygon in the xy plane: one wall an edge, from height `low` to `high` [m].
/// Floor and ceiling are not part of it.
std::vector<Surface> walls(const std::string& name, const std::vector<Eigen::Vector2d>& outline, double low,
                           double high, double reflectance);

/// Puts things elsewhere: turned by `yaw` [rad] about the vertical through the origin, made `scale` times as
/// large, then moved by `by` [m]. How deep beams get into foliage stays.
void place(Scene& scene, double yaw, const Eigen::Vector3d& by, double scale = 1);

/// Adds the things of one scene to another.
void add(Scene& to, const Scene& more);

/// Describes a world, drawn in any frame of its own, from where the scanner stands.
///
/// @param position  [m] the scanner's centre in the world's frame
/// @param yaw       [rad] turn of the scanner's base about the vertical
void look_from(Scene& scene, const Eigen::Vector3d& position, double yaw);

}  // namespace crisp::simulate
