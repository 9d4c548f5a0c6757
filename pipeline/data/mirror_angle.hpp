// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <numbers>

namespace crisp::data {

/// [rad] A mirror angle within half a turn of 0, so that its sign gives the half of the sweep, whatever the
/// mount. An angle of half a turn but for rounding stays.
inline double wrapped_mirror_angle(double angle) {
  constexpr double kRounding = 1e-3;  // [rad] less than any laser's step
  constexpr double kTurn = 2 * std::numbers::pi;
  if (std::abs(angle) <= kTurn / 2 + kRounding) return angle;
  if (std::abs(angle) < 3 * kTurn / 2) return angle - std::copysign(kTurn, angle);  // exact, and quick
  return std::remainder(angle, kTurn);
}

}  // namespace crisp::data
