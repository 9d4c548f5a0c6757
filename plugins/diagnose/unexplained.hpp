// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "plugins/diagnose/departure.hpp"
#include "plugins/diagnose/profiles.hpp"

namespace crisp {

/// Refuses the accepted causes that take less of the residuals, in mean squares over all beams, than what
/// departs from the extended model all the same and has no cause: where much is left that nothing tried
/// describes, the nearest name takes a part of that. A laser's cause is held against what departs in its
/// ranges, or from laser to laser; one of the plate against what departs in any. That is counted over the
/// covariate that shows the most of it, with the shapes that were taken over it and do not suffice.
///
/// What a refused one took is left then, too: once the model is refined without it, ask again.
///
/// @param left   what departs from the model with all that are accepted
/// @param noise  [m] of ranges
/// @return       whether any was
bool refuse_what_leaves_more(std::vector<Departure>& departures, const SideBySide& left, double noise);

}  // namespace crisp
