// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "pipeline/estimate/sample.hpp"

namespace crisp::report {

/// Motion of the plate: times [s from the first], angles [turns] and rates [Hz], at most `most` of them.
/// Between readings farther apart than the trajectory interpolates across, a null breaks each list.
nlohmann::ordered_json motion_json(const PlateTrajectory& plate, std::size_t most = 1500);

/// Coverage of each laser: number of beams by mirror angle (rows, from −180° to 180°) and the plate's angle
/// (columns, from 0° to 360°), in cells of 10°; one table a laser.
nlohmann::ordered_json coverage_json(const estimate::Sample& sample, const std::vector<std::string>& lasers);

}  // namespace crisp::report
