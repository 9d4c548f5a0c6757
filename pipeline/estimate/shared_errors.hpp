// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Which beams may be off by a common error, so that they count for less than their number.

#include <vector>

#include "pipeline/estimate/sample.hpp"
#include "pipeline/quality/surfel_equations.hpp"

namespace crisp::estimate {

/// Division of a recording into blocks of a tenth of a second, or of a hundredth of the recording if that is
/// shorter. Blocks without beams do not exist.
quality::Division recording_blocks(const Measurements& beams);

/// The same division, where the plate stands or creeps with longer blocks: until it has turned by a step of
/// the encoder, all beams have the same quantization error. While the plate turns, its trajectory is smoothed
/// over many steps, and blocks of a tenth of a second are nearly independent.
///
/// @param step  [rad] of the encoder; 0: not quantized
quality::Division quantization_blocks(const Sample& sample, double step);

/// For each beam the hundredth of its laser's scan that it is of: what each direction of a mirror is off by
/// for good, as where it has a weight of its own between two peaks of noise, no piece of the recording shows.
/// A laser of fewer directions has pieces of the recording in their place.
quality::Division scan_blocks(const Measurements& beams);

/// Into how many places a surface is divided.
inline constexpr std::uint32_t kPlacesOfEach = 16;

/// Which of the places of a surface it is.
///
/// @param foot  [m] from its middle, along u and v
std::uint32_t place_on(const quality::Surfel& surfel, const Eigen::Vector2d& foot);

/// For each beam which of a hundred lots of places it meets, see place_on(): where a
/// surface is no plane, it is none at every turn, which no other division shows. Beams of no surface are of
/// the first.
quality::Division place_blocks(const quality::Surfels& surfels, const quality::BeamsView& beams);

/// Divisions into blocks of beams with correlated errors: by quantization_blocks(), scan_blocks() and
/// place_blocks().
///
/// @param placed  the beams of the sample
/// @param step    [rad] of the encoder; 0: not quantized
std::vector<quality::Division> shared_errors(const Sample& sample, const quality::Surfels& surfels,
                                             const quality::BeamsView& placed, double step);

/// @param equations  of m parameters, at their optimum, with divisions
/// @return  m: by how much larger their standard errors are than the noise of single beams makes them, as the
///          blocks disagree. 1 where that may be chance.
Eigen::VectorXd widening(const quality::NormalEquations& equations);

/// The factors by which the standard errors of data and prior together grow if those of the data alone grow
/// by `by`: no parameter ends with more than its prior's.
///
/// @param of_prior  m, 0 to 1: variance over the prior's variance
Eigen::VectorXd widening_with_prior(const Eigen::VectorXd& by, const Eigen::VectorXd& of_prior);

/// A covariance with larger standard errors, of which no combination of parameters is better known than
/// before. (Were parameters that hang together scaled by different factors, some would be.)
///
/// @param by  m: factors of the standard errors, 1 or more
Eigen::MatrixXd widened(const Eigen::MatrixXd& covariance, const Eigen::VectorXd& by);

}  // namespace crisp::estimate
