// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <crisp/error.hpp>

#include "pipeline/estimate/sample.hpp"
#include "pipeline/quality/surfels.hpp"

namespace crisp::estimate {

/// The model moves beams in time beyond the encoder readings.
class UncoveredBeams final : public Error {
 public:
  UncoveredBeams();
};

/// Places n beams by a model.
/// @throws UncoveredBeams  if encoder readings do not cover all of them
Vectors place_all(const SensorModel& model, const Measurements& beams, const PlateTrajectory& plate);

/// Beams placed by a model, with their directions: the input of the surfel segmentation. Each recording
/// (recordings_of()) has a place of its own, a kilometre from the next one's, so that none shares surfaces
/// with another.
class PlacedBeams {
 public:
  /// @param sample  n beams, all of which encoder readings cover
  PlacedBeams(const SensorModel& model, const Sample& sample);

  /// Valid while this and the noise live.
  ///
  /// @param noise  see relative_noise(); or none
  quality::BeamsView view(std::span<const float> noise = {}) const {
    return {.points = points_.view(), .directions = directions_.view(), .views = views_, .noise = noise};
  }

  /// Moves each recording's cloud rigidly, as a whole, to where another model places the same beams (least
  /// squares; Umeyama 1991).
  ///
  /// @param sample  that of both
  void align_with(const PlacedBeams& other, const Sample& sample);

 private:
  Vectors points_;
  Vectors directions_;
  std::vector<std::uint32_t> views_;  // one for each laser and half of its sweep
};

}  // namespace crisp::estimate
