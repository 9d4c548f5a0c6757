// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "pipeline/quality/surfels.hpp"

namespace crisp {

/// Which surfels stand still: those that the views meet at one place, as far as they do so elsewhere.
///
/// Where somebody walked by, views that looked at different times found pieces at different places. Within a
/// view nothing tells them from a wall, but between views they lie decimetres apart and would pull with all
/// of it. A surfel counts as steady if the root mean square distance between its views' means and their
/// common one is at most 5 times that of the median surfel, or a quarter of a standard deviation of a range.
/// Those that are not hold a tenth of the beams at most: where views disagree on more than that, it is the
/// scanner's model that is wrong (floor and ceiling, say, by a laser that sits too low).
///
/// @param noise  [m] standard deviation of a range
/// @return  for each surfel whether it is steady
std::vector<bool> steady(const Surfels& surfels, const BeamsView& beams, double noise);

/// Those surfels alone.
Surfels kept(const Surfels& surfels, const std::vector<bool>& keep);

}  // namespace crisp
