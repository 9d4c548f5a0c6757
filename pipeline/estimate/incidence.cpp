// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/estimate/incidence.hpp"

#include <cmath>

#include "pipeline/quality/blocks.hpp"
#include "pipeline/quality/vector_at.hpp"

namespace crisp::estimate {

std::vector<float> incidences(const quality::Surfels& surfels, const quality::BeamsView& beams) {
  std::vector<float> cosines(beams.points.x.size(), 1.0F);
  quality::for_each_index(surfels.surfels.size(), [&](std::size_t s) {
    const quality::Surfel& surfel = surfels.surfels[s];
    for (const std::uint32_t i : surfels.beams_of(surfel)) {
      const Eigen::Vector3d direction = quality::vector_at(beams.directions, i);
      cosines[i] = static_cast<float>(std::abs(surfel.normal.dot(direction)));
    }
  });
  return cosines;
}

}  // namespace crisp::estimate
