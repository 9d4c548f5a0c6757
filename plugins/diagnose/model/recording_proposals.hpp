// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "plugins/diagnose/model/candidate_search.hpp"
#include "plugins/diagnose/model/effect_resolution.hpp"

namespace crisp::diagnose {

/// A further recording, and from which size on it would resolve each cause, diagnosed together with the
/// recorded one; by itself where recordings do not share a cause, or one that the model has.
struct RecordingProposal {
  std::string recording;  ///< "the plate turning to and fro, at up to 1.5 Hz"
  std::vector<EffectResolution> effects;
};

/// Predicts what other motions of the plate, a tilt of the scanner, and a larger or smaller place would
/// resolve: by Fisher's information of recordings that are predicted from the surfaces at hand. Of several
/// recordings the longest counts.
///
/// @param base  indices of the estimated base parameters (λ, τ, α, η) in the model's values
std::vector<RecordingProposal> propose_recordings(const SensorModel& model,
                                                  const std::vector<std::size_t>& base,
                                                  const SurfaceObservations& observations,
                                                  const TermRegistry& terms,
                                                  const DiagnosisSettings& settings);

/// What would resolve a cause of this size [m], the surest first: those that would, or else the best one.
std::vector<std::string> resolving(const std::vector<RecordingProposal>& proposals, const std::string& cause,
                                   double size);

/// What would show a cause that these data do not show; empty if nothing would.
///
/// @param limit  [m] size below which it is not detectable now
std::string showing(const std::vector<RecordingProposal>& proposals, const std::string& cause, double limit);

}  // namespace crisp::diagnose
