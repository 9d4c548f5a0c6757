// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "pipeline/quality/surfels.hpp"

namespace crisp::test {

/// Surfels across z, made of beams of which each view has some at a height of its own.
struct ViewedSurfels {
  struct Part {
    std::uint32_t view;
    double height;  ///< [m]
    int beams;
  };

  /// Beams a millimetre apart.
  void add(const std::vector<Part>& parts) {
    quality::Surfel surfel{.middle = {0, 0, 0}, .normal = {0, 0, 1}, .u = {1, 0, 0}, .v = {0, 1, 0}};
    surfel.begin = static_cast<std::uint32_t>(surfels.members.size());
    for (const Part& part : parts) {
      for (int k = 0; k < part.beams; ++k) {
        surfels.members.push_back(static_cast<std::uint32_t>(views.size()));
        surfels.weights.push_back(1);
        views.push_back(part.view);
        points.x.push_back(1e-3 * k);
        points.y.push_back(0);
        points.z.push_back(part.height);
      }
    }
    surfel.end = static_cast<std::uint32_t>(surfels.members.size());
    surfels.surfels.push_back(surfel);
  }

  /// Directions are of no use.
  quality::BeamsView view() const {
    return {.points = points.view(), .directions = points.view(), .views = views};
  }

  quality::Surfels surfels;
  Vectors points;
  std::vector<std::uint32_t> views;
};

}  // namespace crisp::test
