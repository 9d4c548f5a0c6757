// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <vector>

#include "pipeline/estimate/sample.hpp"
#include "pipeline/quality/surfels.hpp"

namespace crisp::diagnose {

/// What a scanner would measure in the same scene if its plate turned otherwise, or if it stood tilted.
struct PredictedRecording {
  PlateTrajectory plate;
  Measurements beams;        ///< n, without noise
  quality::Surfels surfels;  ///< whose members are these beams

  estimate::Sample sample() const { return {.beams = beams, .plate = &plate}; }
};

/// Predicts a recording from the surfaces that one has shown: beams of the same lasers, mirror angles and
/// times meet the surface that was seen in their direction. Beams that leave these surfaces are left out.
///
/// @param pattern  beams of one recording, whose lasers, mirror angles and times the predicted ones have
/// @param placed   recorded beams, placed by the model
/// @param surfels  the surfaces that those meet
/// @param angles   [rad] the plate's, one for each of its readings
/// @param attitude rotates vectors of the scanner as it would stand to those of the scanner as it stood
PredictedRecording predicted_recording(const SensorModel& model, const estimate::Sample& pattern,
                                       const quality::BeamsView& placed, const quality::Surfels& surfels,
                                       std::vector<double> angles, const Eigen::Matrix3d& attitude);

}  // namespace crisp::diagnose
