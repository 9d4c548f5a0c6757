// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <vector>

#include <crisp/plate_trajectory.hpp>

namespace crisp::data {

/// Estimates a plate's angle between the steps of its encoder. A whole count is up to half a step from the
/// angle, and all beams between two readings share that error: 0.2 mrad at 16384 counts a turn, 10 mm at 50
/// m.
///
/// A polynomial of the fourth degree is fitted around each moment, over the widest window (the half width, a
/// half and a quarter of it) with a polynomial that no reading contradicts, i.e. within half a step of all
/// readings. Among these polynomials the fit is about the central one, by the least sum of 16th powers, which
/// is up to three times as near to the truth as least squares, as rounding errors are bounded. Where readings
/// contradict all of them, because the plate is shaken or stamps are poor, the fit is least squares over the
/// narrowest window. No angle is moved by more than 0.6 steps.
///
/// @param times       [s] n, ascending
/// @param angles      [rad] n readings, multiples of the step
/// @param step        [rad] of the encoder
/// @param half_width  [s] usually kEncoderSmoothing; 0: the readings as they are
/// @return            [rad] n
std::vector<double> between_steps(std::span<const double> times, std::span<const double> angles, double step,
                                  double half_width);

}  // namespace crisp::data
