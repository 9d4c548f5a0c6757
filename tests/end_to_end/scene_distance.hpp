// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <crisp/cloud.hpp>

#include "grabbers/simulate/scene.hpp"

namespace crisp::test {

/// How far [m, root of the mean square] every `every`th point of a cloud is from the nearest surface of a
/// scene. Distances count up to `most` [m], so that what the scene does not explain is seen but does not
/// drown the rest.
struct SceneDistance {
  double as_it_is = 0;
  /// After the rotation of the whole cloud about the spin axis that fits best. The azimuth of the first laser
  /// defines the frame, and no recording determines its share of α.
  double turned = 0;
  double turn = 0;  ///< [rad] this one
};
SceneDistance distance_to(const simulate::Scene& scene, const Cloud& cloud, std::size_t every,
                          double most = 0.2);

}  // namespace crisp::test
