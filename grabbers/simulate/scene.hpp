// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "grabbers/simulate/solid.hpp"

namespace crisp::simulate {

/// A flat piece of the world, seen from both sides.
struct Surface {
  std::string name;
  std::vector<Eigen::Vector3d> corners;  ///< [m] at least three, in one plane, in order around the edge
  double reflectance = 0.5;              ///< share of the light that comes back from it, 0 to 1
};

/// A way that something goes to and fro, from its first point on, at a steady speed.
struct Walk {
  std::vector<Eigen::Vector3d>
      along;         ///< [m] where it is, off from where it stands; fewer than two: it stays
  double speed = 0;  ///< [m/s]

  bool moves() const { return along.size() > 1 && speed > 0; }
  /// Off from where it stands [m] at a time [s].
  Eigen::Vector3d at(double time) const;
};

/// A piece of the world that has a volume: round, or one that beams get into, or one that moves.
struct Body {
  std::string name;
  Solid shape;
  double reflectance = 0.5;
  double depth =
      0;  ///< [m] that beams get into it in the mean, exponentially distributed: foliage; 0: none does
  Walk walk = {};
};

/// A world in the base's frame: the origin is the scanner's centre, z its spin axis.
struct Scene {
  std::string name;
  std::vector<Surface> surfaces = {};
  std::vector<Body> bodies = {};  ///< where a thing of the scene has an index, they come after the surfaces

  std::size_t things() const { return surfaces.size() + bodies.size(); }
  const std::string& name_of(std::size_t thing) const {
    return thing < surfaces.size() ? surfaces[thing].name : bodies[thing - surfaces.size()].name;
  }
  double reflectance_of(std::size_t thing) const {
    return thing < surfaces.size() ? surfaces[thing].reflectance
                                   : bodies[thing - surfaces.size()].reflectance;
  }
};

}  // namespace crisp::simulate
