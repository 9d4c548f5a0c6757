// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "pipeline/quality/surfel_residuals.hpp"

namespace crisp::quality {

/// Sets the weights of a surfel's residuals, of which those that count have the weight 1: by Tukey's biweight
/// in what is left of each after a plane of its view's own, and to 0 where patches or strips of the surfel
/// lie off these planes by more than chance. However much views disagree, an outlier is what its own view
/// contradicts.
///
/// @param members  the residuals' beams
/// @param views    of all beams; or none, if all are of one
/// @param outlier  [standard deviations] from which on a beam does not count
void weigh(std::vector<SurfelResidual>& residuals, std::span<const std::uint32_t> members,
           std::span<const std::uint32_t> views, double outlier);

}  // namespace crisp::quality
