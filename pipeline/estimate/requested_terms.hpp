// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include <crisp/sensor_model.hpp>

namespace crisp::estimate {

/// Adds terms of the sensor model, neutral, where a calibration does not have them yet.
///
/// @param wanted  "encoder.eccentricity", or "laser2.mirror.cone" for that of one laser
/// @throws Error  for a term that is not known (and names the nearest), or that the owner cannot have
void add_requested_terms(Calibration& calibration, const std::vector<std::string>& requested,
                         const TermRegistry& terms);

/// A term's declaration of its parameter; nullptr for λ, τ, α and η.
const EffectParameter* declared(const SensorModel& model, std::size_t parameter);

/// Whether the parameter is one of the base model: λ, τ, α, η, or that of a nuisance term.
bool is_of_base_model(const SensorModel& model, std::size_t parameter);

/// The amplitude parameters of such terms.
///
/// @param forms  whether shape parameters are included as well, but for instants, which have no derivative
std::vector<std::size_t> parameters_of(const SensorModel& model, const std::vector<std::string>& requested,
                                       bool forms = false);

}  // namespace crisp::estimate
