// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>

#include "pipeline/data/calibration.hpp"
#include "pipeline/model/term.hpp"

namespace crisp {

/// How far the true parameters may lie from the nominal ones.
struct Departures {
  double tau = 0;     ///< [m]
  double alpha = 0;   ///< [rad]
  double lambda = 0;  ///< [rad]; of the first laser it is 0 always: the gauge
  double eta = 0;     ///< [s]
};

/// Draws each parameter of each laser evenly between nominal − departure and nominal + departure.
/// @throws Error if a departure is negative
Calibration draw_truth(const Calibration& nominal, const Departures& departures, std::uint64_t seed);

/// Adds an effect of the model's catalogue to a truth, or sets a further parameter of one that is there.
///
/// @param effect  "laser2.mirror.cone.kappa=0.3deg", "plate.encoder.eccentricity.a=0.1deg", or without the
///                owner: for the plate, or for every laser, as the term is of. Parameters that nobody sets
///                stay at the value that changes nothing.
/// @throws Error  that says which part is not understood and what is known
void add_effect(Calibration& truth, const std::string& effect, const TermRegistry& terms);

}  // namespace crisp
