// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "plugins/diagnose/model/hypothesis.hpp"
#include "plugins/diagnose/model/residual_profiles.hpp"

namespace crisp::diagnose {

/// Rejects accepted causes that explain less mean square of the residuals, over all beams, than the extended
/// model leaves unexplained. Where a large systematic residual has no fitting candidate, the most similar
/// cause absorbs a part of it. A laser's cause is compared with deviations of its own ranges and between
/// lasers, a plate's cause with all deviations. The comparison uses the covariate with the largest deviation,
/// including the fine shapes that were fitted over it.
///
/// A rejected cause adds to the unexplained residual: refine the model without it, then call this again.
///
/// @param left   residual profiles of the model with all accepted terms
/// @param noise  [m] standard deviation of ranges
/// @return       whether a cause was rejected
bool reject_if_residual_exceeds(std::vector<Hypothesis>& hypotheses, const ProfileComparison& left,
                                double noise);

}  // namespace crisp::diagnose
