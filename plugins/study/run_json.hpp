// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json.hpp>

#include "plugins/study/basin.hpp"
#include "plugins/study/trial.hpp"

namespace crisp {

/// A run's result as JSON and back, to the bit: what is computed of it is the same as of the run itself.
nlohmann::json trial_json(const Trial& trial);
Trial trial_of(const nlohmann::json& json);
nlohmann::json basin_json(const BasinRecording& recording);
BasinRecording basin_of(const nlohmann::json& json);

}  // namespace crisp
