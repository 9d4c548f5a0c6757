// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <vector>

namespace crisp {

/// [s] To either side of a moment. A plate has mass: its rate changes smoothly.
inline constexpr double kEncoderSmoothing = 0.2;

/// Where a plate was between the steps of its encoder. A whole count is up to half a step from the angle, and
/// all beams between two readings share that error: 0.2 mrad at 16384 counts a turn, 10 mm at 50 m.
///
/// About each moment the readings are described by a polynomial of the fourth degree, over as wide a window
/// (the half width, a half and a quarter of it) as there is one that no reading contradicts: none is more
/// than half a step away. Of all these it is about the one in the middle, by the least sum of 16th powers;
/// which is up to three times as near to the truth as the one by least squares, as errors of rounding end
/// sharply. Where readings contradict all of them, because the plate is shaken or stamps are poor, it is the
/// one by least squares over the narrowest window. Whatever the plate did, no angle is moved by more than 0.6
/// steps.
///
/// @param times       [s] n, ascending
/// @param angles      [rad] n readings, multiples of the step
/// @param step        [rad] of the encoder
/// @param half_width  [s] 0: the readings as they are
/// @return            [rad] n
std::vector<double> between_steps(std::span<const double> times, std::span<const double> angles, double step,
                                  double half_width);

}  // namespace crisp
