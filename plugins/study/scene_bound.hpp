// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "plugins/study/beam_choice.hpp"

namespace crisp::study {

/// How well a recording could determine a calibration at best.
struct SceneBound {
  std::vector<std::string> parameters;  ///< m that a calibration turns, "laser1.tau": see free_parameters()
  /// m [SI]: the least standard errors of an unbiased estimator without knowledge of the scene (Cramér–Rao),
  /// the unobservable parameters being known; infinite for these.
  Eigen::VectorXd std_errors;
  /// m [SI]: the same where the plate's angle is known but by the steps of its encoder, counted as noise.
  Eigen::VectorXd with_steps;
  /// Not determined better than before the recording, or not by the plate's motion: see
  /// identifiable_parameters().
  std::vector<Unobservable> unobservable;
  std::vector<std::size_t> beams_on;  ///< by surface of the scene
  std::size_t beams = 0;              ///< of which something came back
  std::size_t no_echo = 0;            ///< of which nothing did
};

/// The scanner with exact ranges and an exact encoder; its mirrors and where its beams mix are the same.
simulate::ScannerSettings without_noise(simulate::ScannerSettings scanner);

/// The bound for a scanner at a scene: each of its surfaces counts as a plane of its own, as unknown as the
/// parameters. The ranges' noise is `scanner.range.sigma`; their steps count as exact, and so does the
/// encoder, but for `with_steps`, where it has the counts of the scanner's rig. Terms beyond equation (2) are
/// taken as known.
///
/// @param motion   of the plate, in place of `scanner.motion`
/// @param terms    that `scanner.truth` names
/// @throws Error   if no beam meets anything, or the settings make no sense
SceneBound scene_bound(const simulate::ScannerSettings& scanner, const simulate::Scene& scene,
                       const simulate::Motion& motion, BeamChoice beams, const TermRegistry& terms = {});

}  // namespace crisp::study
