// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pipeline/quality/surfels.hpp"

namespace crisp {

/// Cuts a surfel where it reaches too far: an end of it, what lies beyond a straight line across it, gets the
/// weight 0 if the beams there miss the plane, on average, by more than chance and more than bumps explain.
/// An end has a quarter of the beams at most. Where only one of two faces that adjoin was found, it has beams
/// of the other beyond the edge, all off to the same side. Where a line lies is decided by where beams meet
/// the plane, and all beams beyond it go together, so that the plane is not pulled towards where it was.
///
/// For when parameters hardly move any more: views are judged together, and must agree.
///
/// @param surfel  one of `surfels`, whose weights are set: see refine()
void cut_strange_ends(const Surfel& surfel, Surfels& surfels, const BeamsView& beams,
                      const SurfelSettings& settings);

}  // namespace crisp
