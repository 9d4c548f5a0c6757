// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json.hpp>

#include <crisp/calibration.hpp>

namespace crisp::report {

/// A calibration for a report: parameters in mm, degrees and ms with standard errors, next to the values of
/// the rig and of an earlier calibration, correlations of the free ones, and unobservable ones.
///
/// @param nominal  the rig's values; a parameter that it lacks has none
/// @param against  an earlier calibration of the same scanner; null: none
nlohmann::ordered_json calibration_json(const Calibration& calibration, const Calibration& nominal,
                                        const Calibration* against);

}  // namespace crisp::report
