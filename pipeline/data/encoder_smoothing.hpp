// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <vector>

namespace crisp {

/// [s] To either side of a reading. A plate has mass: within so short a time its rate changes smoothly.
inline constexpr double kEncoderSmoothing = 0.05;

/// Where a plate was between the steps of its encoder. A whole count is up to half a step from the angle, and
/// all beams between two readings share that error: 0.2 mrad at 16384 counts a turn, 10 mm at 50 m. Each
/// reading is replaced by the parabola that fits the readings around it best, as far as rounding leaves that
/// open: whatever the plate did, no angle is moved by more than 0.6 steps.
///
/// @param times       [s] n, ascending
/// @param angles      [rad] n readings, multiples of the step
/// @param step        [rad] of the encoder
/// @param half_width  [s] 0: the readings as they are
/// @return            [rad] n
std::vector<double> between_steps(std::span<const double> times, std::span<const double> angles, double step,
                                  double half_width);

}  // namespace crisp
