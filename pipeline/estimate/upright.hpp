// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pipeline/estimate/sample.hpp"

namespace crisp {

/// Whether all beams lie in the plate's plane (θ = ±90°) to within half a degree, a mirror's coarsest step.
bool is_in_plane(const Sample& sample);

/// Beams in the plate's plane as they would be if they left it a little, up and down, among upright walls:
/// the same places in the plane, but spread along the spin axis. The plane's beams see a wall as a line, of
/// which no surface could be told; spread out, they see it as a strip.
///
/// A beam by ε out of the plane has the mirror angle θ ± ε and the range r / cos ε. How the points move in
/// the plane with λ, τ, α and η stays the same to the last bit that counts; the ranges' noise grows by ε²/2.
///
/// @param sample  beams with θ near ±90°
/// @param spread  [rad] largest ε; which beam gets which, evenly spread, depends on its place in the sample
Sample spread_upright(const Sample& sample, double spread);

}  // namespace crisp
