// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include <crisp/calibration.hpp>
#include <crisp/term.hpp>

#include "grabbers/simulate/effects.hpp"

namespace crisp::simulate {

/// Largest deviations of the true parameters from the nominal ones.
struct NominalErrors {
  double tau = 0;     ///< [m]
  double alpha = 0;   ///< [rad]
  double lambda = 0;  ///< [rad]; of the first laser it is 0 always: the gauge
  double eta = 0;     ///< [s]
};

/// Draws each parameter of each laser evenly between nominal − departure and nominal + departure.
/// @throws Error if a departure is negative
Calibration draw_truth(const Calibration& nominal, const NominalErrors& nominal_errors, std::uint64_t seed);

/// Adds effects that are terms of the sensor model to a truth, or sets further parameters of those that are
/// there. Parameters that nobody sets stay at the value that changes nothing.
///
/// @throws Error for an effect that is no term
void add_terms(Calibration& truth, const std::vector<Effect>& effects, const TermRegistry& terms);

}  // namespace crisp::simulate
