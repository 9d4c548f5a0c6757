// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <numbers>

namespace crisp {

/// [rad] A mirror angle within half a turn of 0, so that its sign gives the half of the sweep, whatever the
/// mount. An angle of half a turn but for rounding stays.
inline double wrapped_mirror_angle(double angle) {
  constexpr double kRounding = 1e-3;  // [rad] less than any laser's step
  if (std::abs(angle) <= std::numbers::pi + kRounding) return angle;
  return std::remainder(angle, 2 * std::numbers::pi);
}

}  // namespace crisp
