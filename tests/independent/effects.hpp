// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <random>
#include <string>

#include "tests/independent/draws.hpp"
#include "tests/independent/motion.hpp"
#include "tests/independent/world.hpp"

namespace independent {

/// The plate's frame in the scene: z is the spin axis.
struct Pose {
  Vector origin;
  Axes axes;
};

/// What a laser receives from a surface.
struct Echo {
  double range = 0;      ///< [m]
  double incidence = 0;  ///< cosine of the angle between beam and surface normal
  double remission = 0;  ///< 1 to 254
  double time = 0;       ///< [s]
  double theta = 0;      ///< mirror angle [rad]
};

/// One departure of the scanner from a plain one, in a form of its own. Each function gives the departure at
/// size 1; those that are empty leave the scanner as it is.
struct Effect {
  std::string cause = "none";  ///< as docs/effects.md calls it; "shape": nothing that it knows
  std::string form = "none";
  int laser = -1;   ///< the only laser that has it; −1: all of them
  double size = 1;  ///< factor of all functions

  std::function<Pose(const Pose&, double size, double time, double angle)> pose;
  std::function<double(double time)> encoder;     ///< reported less true plate angle [rad]
  std::function<double(double theta)> mirror;     ///< true less reported mirror angle [rad]
  std::function<double(double theta)> elevation;  ///< of the beam above the scan plane [rad]
  std::function<double(const Echo&)> range;       ///< reported less true range [m]
  std::function<double(double time)> clock;       ///< of the laser's clock, fast [s]
  std::function<double(const Echo&, double sigma, std::mt19937_64&)> noise;  ///< more noise [m]
  double tilt = 0;  ///< of the scan plane about its horizontal line [rad]
  double spot = 0;  ///< full angle of the beam's footprint; edges average two ranges [rad]

  bool acts_on(std::size_t one) const { return laser < 0 || static_cast<std::size_t>(laser) == one; }
};

/// Draws an effect if `has_effect` or `effect` (the name of a form) is fixed. `effect_laser`: −1 is all
/// lasers.
///
/// @param lasers  of the scanner
Effect draw_effect(Draws& draws, int lasers, const PlateMotion& motion, double duration);

}  // namespace independent
