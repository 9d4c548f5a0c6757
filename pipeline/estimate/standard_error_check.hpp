// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pipeline/estimate/outcome.hpp"
#include "pipeline/estimate/parameter_prior.hpp"

namespace crisp::estimate {

/// Refuses standard errors of λ, τ, α and η that the noise of so many beams does not allow: a fault of this
/// program, as where one beam was taken to move infinitely fast.
///
/// @param floor  [m] least standard deviation across a surface
/// @param prior  what the rig knows may be better known than by the beams
/// @throws Error  if there is one
void check_errors(const Outcome& outcome, const Measurements& beams, double floor,
                  const ParameterPrior& prior);

}  // namespace crisp::estimate
