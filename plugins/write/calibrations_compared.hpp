// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include <crisp/calibration.hpp>

namespace crisp::write {

/// A table for people: each parameter of two calibrations in degrees, mm and ms, and by how much the second
/// differs from the first, also in standard errors where one of them has any. Figures go to the second digit
/// of the standard error.
std::string compare_calibrations(const Calibration& first, const Calibration& second);

}  // namespace crisp::write
