// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace crisp {

/// A flat piece of the world, seen from both sides.
struct Surface {
  std::string name;
  std::vector<Eigen::Vector3d> corners;  ///< [m] at least three, in one plane, in order around the edge
  double reflectance = 0.5;              ///< share of the light that comes back from it, 0 to 1
};

/// A world of flat pieces in the base's frame: the origin is the scanner's centre, z its spin axis.
struct Scene {
  std::string name;
  std::vector<Surface> surfaces;
};

}  // namespace crisp
