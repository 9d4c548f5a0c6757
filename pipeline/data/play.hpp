// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>

namespace crisp::data {

/// [rad] By how much a plate turns back until its direction counts as reversed: more than the play of a
/// plate's drive, and more than the noise of an encoder's readings at standstill.
inline constexpr double kReversalTravel = 0.01;

/// In which direction a plate has turned last: the play operator (Krasnosel'skii and Pokrovskii, Systems with
/// Hysteresis, 1989, §2). The direction is kept at standstill, and changes in proportion to the angle over
/// `kReversalTravel` after a reversal. Angles of monotone motion may be left out.
class Play {
 public:
  /// @param angle      [rad] φ at first
  /// @param direction  −1 to 1, of the motion before
  Play(double angle, double direction) : middle_(angle - kHalf * direction) {}

  /// The direction at the next angle [rad]: −1 clockwise, 1 counter-clockwise, between them while it
  /// reverses.
  double follow(double angle) {
    const double direction = (angle - middle_) / kHalf;
    if (std::abs(direction) < 1 - 1e-9) return direction;  // or 1, but for rounding
    *this = Play(angle, std::copysign(1.0, direction));
    return std::copysign(1.0, direction);
  }

  static constexpr double kHalf = kReversalTravel / 2;  ///< [rad] angle per unit of direction

 private:
  double middle_;  // [rad]
};

}  // namespace crisp::data
