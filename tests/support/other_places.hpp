// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>

#include <crisp/error.hpp>

#include "grabbers/simulate/scene.hpp"

namespace crisp::test {

/// A scene of surfaces as a scanner sees it that stands turned by this, or where all is so many times as far.
inline simulate::Scene seen_from_elsewhere(simulate::Scene scene, const Eigen::Matrix3d& attitude,
                                           double times_as_far = 1) {
  if (!scene.bodies.empty()) throw Error("a scene with bodies is not seen from elsewhere");
  for (auto& surface : scene.surfaces)
    for (auto& corner : surface.corners) corner = times_as_far * (attitude.transpose() * corner);
  return scene;
}

}  // namespace crisp::test
