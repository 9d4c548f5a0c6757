// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <vector>

#include "plugins/diagnose/model/cross_validation.hpp"
#include "plugins/diagnose/model/hypothesis.hpp"

namespace crisp::diagnose {

/// Held-out score of a calibration with its terms: of either half of the turns, fitted to the other alone.
using HeldOutScore = std::function<CrossValidator::Score(const Calibration& start)>;

/// Accepts hypotheses that generalize to held-out turns (forward cross-validation): adds them one by one,
/// fits each model to the training turns and compares the held-out likelihood. If a cause of several lasers
/// fails for one laser, it is tested for all of them jointly: corrected in one alone, the lasers disagree. A
/// member of a family that fails is tested with the family's others: each may make up for what another lacks.
///
/// @param hypotheses  their gains and acceptance are set, except of those already rejected
/// @param plain       score of the model without hypotheses
/// @param found       calibration with all hypotheses; start of the other fits
void accept_if_it_generalizes(std::vector<Hypothesis>& hypotheses, const CrossValidator::Score& plain,
                              const Calibration& found, const HeldOutScore& held_out,
                              const TermRegistry& terms);

}  // namespace crisp::diagnose
