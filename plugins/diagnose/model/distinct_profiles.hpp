// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "plugins/diagnose/model/quantile_bins.hpp"
#include "plugins/diagnose/model/residuals.hpp"

namespace crisp::diagnose {

/// Marks the significant profiles that are shadows of others. One deviation shows over several covariates:
/// what depends on the mirror angle, for example, also depends on the incidence a little, since a laser sees
/// the floor at other angles than the walls.
///
/// Forward selection: the profile that explains most of the residuals is distinct, and its means are
/// subtracted from the residuals. A profile of which less than half remains then (RMS), or nothing
/// significant, is a shadow. The profiles of all lasers over the plate's angle, its rate or time are selected
/// together: what moves the plate or the base moves all lasers.
///
/// @param profiles   one for each layout, with means, errors and p-values
/// @param residuals  measured ones
/// @param tests      effective number of tested profiles
void mark_shadows(std::vector<Profile>& profiles, const std::vector<QuantileBins>& layouts,
                  const WeightedResiduals& residuals, double tests);

}  // namespace crisp::diagnose
