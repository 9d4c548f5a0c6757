// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "grabbers/simulate/scene.hpp"
#include "pipeline/data/cloud.hpp"

namespace crisp::test {

/// Root of the mean square distance [m] of a cloud's points to the nearest surface of a scene, of every
/// `every`th point. Distances count up to `most` [m], so that what the scene does not explain is seen but
/// does not drown the rest.
double rms_distance(const Cloud& cloud, const Scene& scene, std::size_t every, double most = 0.2);

}  // namespace crisp::test
