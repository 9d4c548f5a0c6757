// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "plugins/study/beam_choice.hpp"

namespace crisp::study {

/// Result of calibrate.refine for a recording.
struct RefinementAccuracy {
  Eigen::VectorXd std_errors;  ///< [SI] that it gives itself; infinite for what it leaves as it was
  std::size_t beams = 0;       ///< that it uses
  std::size_t surfaces = 0;    ///< that it finds
  std::string failure;         ///< why there are no errors; empty otherwise
};

/// Simulates one recording, noise and all, and refines it from the true parameters on, with the noise known.
/// Against scene_bound() it shows what the method gives away: beams on surfaces that it does not find or
/// parts, and the safety against outliers.
///
/// @param parameters  whose errors are wanted, in this order: SceneBound::parameters
RefinementAccuracy refinement_accuracy(const simulate::ScannerSettings& scanner, const simulate::Scene& scene,
                                       const simulate::Motion& motion, BeamChoice beams,
                                       const std::vector<std::string>& parameters,
                                       const TermRegistry& terms = {});

}  // namespace crisp::study
