// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include <crisp/calibration.hpp>
#include <crisp/context.hpp>

#include "pipeline/estimate/surfel_refinement.hpp"

namespace crisp::calibrate {

/// Shows a refinement's rounds as progress, and ends it where the run is interrupted.
estimate::RoundReporter rounds_of(Context& context);

/// A refinement that fits, where the given one, whose views disagree or which contradicts the rig, ended in a
/// local minimum: the entropy of a short recording may be least far from the optimum. It begins with
///   - the rig's nominal values, or their mirror image where the rig leaves the encoder's direction open;
///   - the lasers that agree, to which the others are added one by one (see calibrated_one_by_one());
///   - the first laser and the nominal values, to which all others are added.
///
/// @param refined  of `sample`
/// @param start    from which it was refined
/// @return  the first that fits; nothing if `refined` fits, or none does
std::optional<estimate::Refinement> refined_from_another_start(const estimate::Refinement& refined,
                                                               const estimate::Sample& sample,
                                                               const Calibration& start,
                                                               const estimate::RefinementSettings& settings,
                                                               Context& context);

}  // namespace crisp::calibrate
