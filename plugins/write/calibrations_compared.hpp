// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include <crisp/calibration.hpp>

namespace crisp {

/// A table for people: each parameter of two calibrations in degrees, mm and ms, and by how much the second
/// differs from the first, also in standard errors where one of them has any. Figures go to the second digit
/// of the standard error.
std::string compare_calibrations(const Calibration& first, const Calibration& second);

/// Name of a figure of a calibration's quality for people: "chi2 (misfit)".
std::string figure_in_words(const std::string& name);

}  // namespace crisp
