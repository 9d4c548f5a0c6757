// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pipeline/quality/surfels.hpp"

namespace crisp::quality {

/// Rejects the ends of a surfel that reaches too far: an end, i.e. the beams beyond a straight line across
/// it, gets the weight 0 if its mean distance from the plane is beyond chance and beyond surface bumps. An
/// end has a quarter of the beams at most. Where only one of two adjoining faces was segmented, it has beams
/// of the other beyond the edge, all off to the same side. The line's position is decided by the beams'
/// positions on the plane, and all beams beyond it are rejected together, so that the plane is not biased
/// towards its earlier position.
///
/// For when parameters hardly move any more: views are judged together, and must agree.
///
/// @param surfel  one of `surfels`, whose weights are set: see refine()
void cut_strange_ends(const Surfel& surfel, Surfels& surfels, const BeamsView& beams,
                      const SurfelSettings& settings);

}  // namespace crisp::quality
