// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "pipeline/quality/surfels.hpp"

namespace crisp::estimate {

/// Detects static surfels: those that the views meet at the same place, relative to the other surfels.
///
/// Where somebody walked by, views at different times found pieces at different places. Within a view these
/// are indistinguishable from a wall, but between views they lie decimetres apart and would bias the fit. A
/// surfel counts as static if the root mean square distance between its views' means and their common one is
/// at most 5 times that of the median surfel, or a quarter of a standard deviation of a range. The rejected
/// ones hold a tenth of the beams at most: where views disagree on more than that, the scanner's model is
/// wrong (floor and ceiling, for example, by a laser that sits too low).
///
/// @param noise  [m] standard deviation of a range
/// @return  for each surfel whether it is static
std::vector<bool> static_surfaces(const quality::Surfels& surfels, const quality::BeamsView& beams,
                                  double noise);

/// The selected surfels.
quality::Surfels kept(const quality::Surfels& surfels, const std::vector<bool>& keep);

}  // namespace crisp::estimate
