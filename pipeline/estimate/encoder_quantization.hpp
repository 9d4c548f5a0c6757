// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "pipeline/estimate/sample.hpp"
#include "pipeline/quality/surfels.hpp"

namespace crisp::estimate {

/// The noise of each beam, inflated by the design effect of the encoder's quantization, an error that beams
/// share: its own noise, in units of `noise`, times
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
std::vector<float> noise_with_quantization(const quality::Surfels& surfels, const quality::BeamsView& beams,
                                           const Sample& sample, double step, double noise);

}  // namespace crisp::estimate
