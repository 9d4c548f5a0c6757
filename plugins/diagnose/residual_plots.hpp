// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "pipeline/plot/plot.hpp"
#include "plugins/diagnose/profiles.hpp"

namespace crisp {

/// One laser's residuals: how they are distributed, in units of their noise, then their means [mm] against
/// each covariate, with bars of two standard errors either way. Measured beside simulated, with the model
/// that came and with the extended one. Angles are in degrees; what is no quantity has names.
///
/// @param laser   or kAllLasers: what they differ by
/// @param lasers  their names
/// @param after   the same as `before` where nothing was found: it is left out then
std::vector<Plot> residual_plots(std::size_t laser, const std::vector<std::string>& lasers,
                                 const SideBySide& before, const SideBySide& after);

}  // namespace crisp
