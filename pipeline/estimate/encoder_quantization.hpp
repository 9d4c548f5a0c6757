// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "pipeline/estimate/sample.hpp"
#include "pipeline/quality/surfels.hpp"

namespace crisp {

/// By how much less beams tell than their ranges' noise says, as they share the errors of the plate's angle:
/// for each its noise, in units of `noise`, times
///
///     √(1 + n (ρ δ / σ)²)
///
/// where ρ is by how much its distance from the surface changes with the plate's angle, δ the standard
/// deviation of an angle that is known to a step of the encoder (step / √12), σ the beam's own noise, and n
/// how many beams were fired while the encoder stood between the same two counts.
///
/// @param step   [rad] of the encoder
/// @param noise  [m] standard deviation of a range
/// @return       of each beam; of those on no surface their own
std::vector<float> noise_with_quantization(const Surfels& surfels, const BeamsView& beams,
                                           const Sample& sample, double step, double noise);

}  // namespace crisp
