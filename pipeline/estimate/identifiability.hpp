// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pipeline/estimate/free_parameters.hpp"
#include "pipeline/estimate/parameter_prior.hpp"
#include "pipeline/estimate/sample.hpp"

namespace crisp::estimate {

/// Why identifiable_parameters() removed a parameter.
inline constexpr const char* kNotByMotion = "it is not identifiable from the motion of the plate";

/// Removes `parameters` that are not identifiable from the plate's motion: directions along which, over their
/// whole search range, the cloud's points move by less than 5 mm apart from rigid motions. An example is the
/// η of a plate at constant speed, which turns a laser's cloud as its λ does.
///
/// The motion is taken from readings 50 ms apart: between closer ones the encoder's rounding resembles
/// changes of speed, which a million beams would count as information.
///
/// Parameters of terms stay: their effects are small, and the data decide on their identifiability.
FreeParameters identifiable_parameters(FreeParameters parameters, const SensorModel& model,
                                       const Sample& sample, const ParameterPrior& range);

}  // namespace crisp::estimate
