// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "grabbers/simulate/noise.hpp"
#include "grabbers/simulate/ray_caster.hpp"

namespace crisp::simulate {

/// A beam's echo as the laser receives it.
struct SpotEcho {
  Hit hit;              ///< of the strongest ray; its distance is the echo's
  double strength = 0;  ///< share of the light that a white surface would send back to the near laser, 0 to 1
};

/// Sends beams into a scene and hears their echoes: thin ones, or with a spot that may lie on several
/// surfaces at once (effect `noise.mixed_pixels`).
class Spot {
 public:
  /// @param reflectances  of the scene's things
  Spot(const NoiseEffects& effects, double max_distance, std::vector<double> reflectances);

  /// The echo of a beam, or nothing where none comes back.
  ///
  /// A wide spot is seven rays of equal areas: the middle and six around it. Where all that hit meet the
  /// middle's surface, the echo is the middle's: how a tilted surface stretches an echo is range.incidence.
  /// Otherwise rays whose neighbours in distance are within `merge` make one echo, whose distance is their
  /// mean, weighted by their strengths; of several echoes the strongest is heard.
  std::optional<SpotEcho> echo(const RayCaster& scene, const Ray& beam, const Shot& shot = {}) const;

 private:
  std::optional<SpotEcho> thin(const RayCaster& scene, const Ray& ray, const Shot& shot) const;

  double divergence_;
  double aperture_;
  double merge_;
  double max_distance_;
  std::vector<double> reflectances_;
};

}  // namespace crisp::simulate
