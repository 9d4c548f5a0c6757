// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <vector>

#include "pipeline/estimate/sample.hpp"
#include "pipeline/quality/surfels.hpp"

namespace crisp::diagnose {

/// Where the scanner would stand, relative to the recording's place.
struct Standpoint {
  /// Rotates vectors of the scanner as it would stand to those of the scanner as it stood.
  Eigen::Matrix3d attitude = Eigen::Matrix3d::Identity();
  double distance = 1;  ///< how many times as far surfaces would be: another place of the same shape
};

/// What a scanner would measure if its plate turned otherwise, or from another standpoint.
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
PredictedRecording predicted_recording(const SensorModel& model, const estimate::Sample& pattern,
                                       const quality::BeamsView& placed, const quality::Surfels& surfels,
                                       std::vector<double> angles, const Standpoint& standpoint);

}  // namespace crisp::diagnose
