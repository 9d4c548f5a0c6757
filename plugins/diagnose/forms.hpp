// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "pipeline/estimate/surfel_refinement.hpp"
#include "plugins/diagnose/evidence.hpp"

namespace crisp {

/// The candidates with their forms (a period, an instant) as finely told as the data allow: between those
/// that were tried, each beside all the others. Those of candidates that the model already has stay; the
/// others are told how far off another form may be.
///
/// @param base   indices of λ, τ, α, η that are estimated with them
/// @param beams  that forms are looked at with
std::vector<Candidate> with_sharper_forms(std::vector<Candidate> chosen, const SensorModel& model,
                                          const std::vector<std::size_t>& base, const Evidence& evidence,
                                          std::size_t beams, const TermRegistry& terms);

/// By how much another form than the best may be the right one, for all of the term's parameters: the
/// covariance of those that they have in all forms that are tried, each as likely as the data make it. A form
/// that a small part of an effect hangs on (a sway beside a larger drift) has rivals far off, of which its
/// own curvature knows nothing; and how strong an effect is may hang on its form.
///
/// @param sharing  see Look::sharing(), of the candidate where the model has it
/// @return         p × p, in the order and the units of the term's parameters; empty if no other was looked
/// at
Eigen::MatrixXd form_covariance(const std::vector<Candidate::OtherForm>& others, double sharing);

}  // namespace crisp
