// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "pipeline/estimate/sample.hpp"
#include "pipeline/quality/surfel_turns.hpp"

namespace crisp {

/// The plate's motion cut into moments of a twentieth of a second, in each of which what is left of the
/// encoder's steps turns all beams by about one angle.
struct PlateMoments {
  std::vector<std::uint32_t> of_beam;  ///< for each beam its moment, from 0
  std::vector<double> variances;       ///< [rad²] of each moment's turn

  SharedTurns turns() const { return {.moments = of_beam, .variances = variances}; }
};

/// @param model   says when a beam was fired by the plate's clock
/// @param sample  whose plate was where its readings say, to a fraction of a step
/// @param step    [rad] of the encoder, > 0
PlateMoments plate_moments(const SensorModel& model, const Sample& sample, double step);

/// Variance [rad²] of the mean error of readings that are rounded to whole steps, over all places between two
/// steps where the first of them may have been.
///
/// The errors of two readings between which the plate turns by d steps have the covariance
/// step² (1/12 − f (1 − f) / 2), f being the fraction of d. While the plate turns by ever different parts of
/// a step from reading to reading, errors average out; at rest, and where its rate hardly changes and comes
/// to whole steps a reading, they do not.
///
/// @param angles  [rad] where the plate was at each reading, to a fraction of a step; at least one
double variance_of_mean_reading(std::span<const double> angles, double step);

}  // namespace crisp
