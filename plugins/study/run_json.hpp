// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json.hpp>

#include "plugins/study/basin.hpp"
#include "plugins/study/monte_carlo_trial.hpp"

namespace crisp::study {

/// A run's result as JSON and back, to the bit: what is computed of it is the same as of the run itself.
nlohmann::json trial_json(const MonteCarloTrial& trial);
MonteCarloTrial trial_of(const nlohmann::json& json);
nlohmann::json basin_json(const BasinRecording& recording);
BasinRecording basin_of(const nlohmann::json& json);

}  // namespace crisp::study
