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
/// @param base  indices of λ, τ, α, η that are estimated with them
std::vector<Candidate> with_sharper_forms(std::vector<Candidate> chosen, const SensorModel& model,
                                          const std::vector<std::size_t>& base, const Evidence& evidence,
                                          const TermRegistry& terms);

/// By how much the form may be another than the best, in the unit of its parameter: the spread of all that
/// are tried, each as likely as the data make it. A form that a small part of an effect hangs on (a sway
/// beside a larger drift) has rivals far off, of which its own curvature knows nothing.
///
/// @param sharing  see Look::sharing(), of the candidate where the model has it
double form_error(const std::vector<Candidate::OtherForm>& others, double sharing);

}  // namespace crisp
