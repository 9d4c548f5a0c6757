// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <limits>
#include <string>
#include <vector>

#include <crisp/rig.hpp>

#include "pipeline/estimate/parameter_prior.hpp"

namespace crisp::calibrate {

/// Squared distance of a calibration from nominal values, in their standard deviations.
struct RigDistance {
  double sum = std::numeric_limits<double>::infinity();
  double largest = 0;  ///< of one laser
};

/// In the frame in which the sum is smallest.
///
/// @param range  [m, rad] of τ and α; half of it is the standard deviation of those that have none in the rig
RigDistance distance_from_nominal(const Calibration& found, const Calibration& nominal,
                                  const estimate::ParameterPrior& range);

/// A usual mistake of a rig, with the calibration's distance from the nominal values without it.
struct RigMistake {
  std::string statement;
  std::string remedy;
  RigDistance distance = {};
  bool keeps_sense = false;  ///< whether the cloud is no mirror image of the scene, whatever is true

  double sum() const { return distance.sum; }
};

/// The usual mistakes of a rig: the encoder's direction (the first), lasers upside down, two exchanged ones,
/// azimuths of the other sign.
std::vector<RigMistake> rig_mistakes(const Calibration& found, const Rig& rig,
                                     const estimate::ParameterPrior& range);

/// What is wrong in the rig, and what to change. Several alternatives, the likeliest first: the nominal
/// values do not decide between them.
std::string caveat_of(const std::vector<RigMistake>& alternatives);

}  // namespace crisp::calibrate
