// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "pipeline/model/sensor_model.hpp"

namespace crisp {

/// Adds terms of the sensor model, neutral, where a calibration does not have them yet.
///
/// @param wanted  "encoder.eccentricity", or "laser2.mirror.cone" for that of one laser
/// @throws Error  for a term that is not known (and names the nearest), or that the owner cannot have
void add_wanted_terms(Calibration& calibration, const std::vector<std::string>& wanted,
                      const TermRegistry& terms);

/// What a term says of its parameter; nullptr for λ, τ, α and η.
const EffectParameter* declared(const SensorModel& model, std::size_t parameter);

/// The parameters of such terms that say how large an effect is.
///
/// @param forms  whether those that say its form are wanted as well, but for instants, which have no
///               derivative
std::vector<std::size_t> parameters_of(const SensorModel& model, const std::vector<std::string>& wanted,
                                       bool forms = false);

}  // namespace crisp
