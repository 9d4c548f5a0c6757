// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>

#include "pipeline/quality/surfel_equations.hpp"

namespace crisp::quality {

/// An error that beams share: all beams of one moment are turned about the z axis by one angle, with
/// independent angles for different moments. The residual of the steps of a plate's encoder.
struct SharedTurns {
  std::span<const std::uint32_t> moments;  ///< for each beam its moment, from 0
  std::span<const double> variances;       ///< [rad²] of each moment's angle, > 0
};

/// NormalEquations::matrix where beams share turns: these are unknowns as the planes are, but such as are
/// known to be small beforehand, and are projected out with them (generalised least squares, beams of a
/// moment being correlated). A turn moves beams on many surfels, so that planes do not go one by one; but
/// no turn stands in an equation with another, so that turns go first, and leave a dense problem in three
/// unknowns a surfel, however many moments there are.
///
/// Deterministic, on any number of threads.
///
/// @return  m × m: the information on the parameters, in the units of normal_equations()
Eigen::MatrixXd information_with_turns(const Surfels& surfels, const BeamsView& beams, std::size_t parameters,
                                       const DerivativeRows& derivatives, const SurfelSettings& settings,
                                       const SharedTurns& turns);

}  // namespace crisp::quality
