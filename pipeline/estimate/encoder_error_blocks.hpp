// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "pipeline/estimate/sample.hpp"
#include "pipeline/quality/encoder_nuisance.hpp"

namespace crisp::estimate {

/// The plate's motion cut into moments of a twentieth of a second, in each of which what is left of the
/// encoder's steps turns all beams by about one angle.
struct EncoderErrorBlocks {
  std::vector<std::uint32_t> of_beam;  ///< for each beam its moment, from 0
  std::vector<double> variances;       ///< [rad²] of each moment's turn

  quality::SharedTurns turns() const { return {.moments = of_beam, .variances = variances}; }
};

/// @param model   gives the time of each beam by the plate's clock
/// @param sample  with encoder readings accurate to a fraction of a step
/// @param step    [rad] of the encoder, > 0
EncoderErrorBlocks encoder_error_blocks(const SensorModel& model, const Sample& sample, double step);

/// Variance [rad²] of the mean error of readings that are rounded to whole steps, over all positions of the
/// first one between two steps.
///
/// The errors of two readings between which the plate turns by d steps have the covariance step² (1/12 − f (1
/// − f) / 2), f being the fraction of d. While the plate turns by ever different parts of a step from reading
/// to reading, errors average out; they do not while it is stationary, or where its rate hardly changes and
/// amounts to whole steps a reading.
///
/// @param angles  [rad] the plate's angle at each reading, to a fraction of a step; at least one
double variance_of_mean_reading(std::span<const double> angles, double step);

}  // namespace crisp::estimate
