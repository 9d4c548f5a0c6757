// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "pipeline/data/calibration.hpp"
#include "pipeline/data/measurements.hpp"

namespace crisp {

/// A laser whose beams all have one mirror angle is no scanner: turning its mirror by alpha is the same as
/// turning its mount by lambda, and no more than a distance from the spin axis tells tau.
/// @param lasers  of the rig, whose names are told
/// @param fixed   parameters that are not estimated: laser1.alpha, or alpha for that of all lasers
/// @throws Error  that names the lasers with such beams whose alpha is to be estimated
void refuse_single_beams(const Measurements& beams, const Calibration& lasers,
                         const std::vector<std::string>& fixed);

}  // namespace crisp
