// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include <crisp/findings.hpp>

#include "plugins/diagnose/noise/noise_components.hpp"

namespace crisp::diagnose {

/// [m²] Mean product of the errors of consecutive beams in a scan: their common-mode error. 0 without such
/// pairs.
///
/// @param model  noise model of the errors; values that are improbable under it are left out
double shared_by_neighbours(const RangeErrors& errors, const NoiseModel& model);

/// Reason to reject a noise component that generalizes to held-out data; empty if it holds.
///
/// @param found  with its parameters and standard errors
/// @param model  noise model with the component
std::string rejection_reason(const Finding& found, const NoiseComponent& component, const NoiseModel& model,
                             const RangeErrors& errors);

}  // namespace crisp::diagnose
