// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "pipeline/plot/plot.hpp"
#include "plugins/diagnose/model/residual_profiles.hpp"

namespace crisp::diagnose {

/// Plots of one laser's residuals: the distribution of standardized residuals, then the mean residual [mm]
/// over each covariate with bars of ± 2 standard errors. Each shows measured and simulated residuals, for the
/// incoming and the extended model. Angles are in degrees; categories are labelled.
///
/// @param laser   or kAllLasers: mean residual by laser
/// @param lasers  names of the lasers
/// @param after   equal to `before` if the model was not extended; it is left out then
std::vector<plot::Plot> residual_plots(std::size_t laser, const std::vector<std::string>& lasers,
                                       const ProfileComparison& before, const ProfileComparison& after);

}  // namespace crisp::diagnose
