// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "pipeline/data/calibration.hpp"

namespace crisp {

/// A table for people: each parameter of two calibrations in degrees, mm and ms, and by how much the second
/// differs from the first, also in standard errors where one of them has any. Figures go to the second digit
/// of the standard error.
std::string side_by_side(const Calibration& first, const Calibration& second);

/// A figure of a calibration's quality as people are told it: "chi2 (misfit)".
std::string figure_in_words(const std::string& name);

}  // namespace crisp
