// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "pipeline/estimate/outcome.hpp"
#include "plugins/diagnose/model/hypothesis.hpp"

namespace crisp::diagnose {

/// Index of each parameter of a candidate's term in the outcome's covariance; empty for parameters that were
/// not estimated.
std::vector<std::optional<Eigen::Index>> parameter_indices(const Candidate& candidate,
                                                           const estimate::Outcome& outcome);

/// Rejects small causes that several lasers share: deviations of real surfaces from planes affect all lasers
/// alike, and many causes absorb a part of them. A cause that is much larger in one laser is its own: the
/// others share it only because surfaces follow that laser.
void reject_scene_artifacts(std::vector<Hypothesis>& hypotheses);

/// Rejects accepted terms that are not significant in the joint fit: by the Wald test of all parameters of a
/// term but its form, or by the term's score test if the fit holds some of them, since these data determine
/// combinations only. A term may have been needed only next to others that were then rejected.
///
/// @param p_value  significance level
/// @return         whether a term was rejected; if so, refit without it and call this again
bool reject_insignificant(std::vector<Hypothesis>& hypotheses, const estimate::Outcome& outcome,
                          const TermRegistry& terms, double p_value);

}  // namespace crisp::diagnose
