// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include <crisp/calibration.hpp>
#include <crisp/measurements.hpp>

namespace crisp::calibrate {

/// A laser whose beams all have one mirror angle is no scanner: rotating its mirror by alpha equals rotating
/// its mount by lambda, and only a distance from the spin axis determines tau.
/// @param lasers  of the rig, named in the message
/// @param fixed   parameters that are not estimated: laser1.alpha, or alpha for that of all lasers
/// @throws Error  that names the lasers with such beams whose alpha is to be estimated
void refuse_single_beams(const Measurements& beams, const Calibration& lasers,
                         const std::vector<std::string>& fixed);

}  // namespace crisp::calibrate
