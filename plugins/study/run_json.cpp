// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/study/run_json.hpp"

#include <cmath>
#include <limits>
#include <string>

namespace crisp::study {
namespace {

using Json = nlohmann::json;

/// JSON has no other numbers than finite ones.
Json number_json(double value) {
  if (std::isfinite(value)) return value;
  return std::isnan(value) ? "nan" : value > 0 ? "inf" : "-inf";
}

double number_of_json(const Json& json) {
  if (json.is_number()) return json.get<double>();
  if (json == "nan") return std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  return json == "-inf" ? -infinity : infinity;
}

template <class Numbers>
Json numbers_json(const Numbers& values) {
  Json json = Json::array();
  for (const double value : values) json.push_back(number_json(value));
  return json;
}

std::vector<double> numbers_of(const Json& json) {
  std::vector<double> values;
  for (const auto& value : json) values.push_back(number_of_json(value));
  return values;
}

Eigen::VectorXd vector_of(const Json& json) {
  const auto values = numbers_of(json);
  return Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
}

Json estimate_json(const Estimate& estimate) {
  return {{"error", numbers_json(estimate.error)},
          {"std_error", numbers_json(estimate.std_error)},
          {"failure", estimate.failure}};
}

Estimate estimate_of(const Json& json) {
  return {.error = vector_of(json.at("error")),
          .std_error = vector_of(json.at("std_error")),
          .failure = json.at("failure")};
}

Json start_json(const BasinStart& start) {
  return {{"start", numbers_json(start.start)}, {"ending", static_cast<int>(start.ending)},
          {"off", number_json(start.off)},      {"farthest", start.farthest},
          {"error", number_json(start.error)},  {"caveats", start.caveats}};
}

BasinStart start_of(const Json& json, std::uint64_t recording) {
  return {.recording = recording,
          .start = numbers_of(json.at("start")),
          .ending = static_cast<Ending>(json.at("ending").get<int>()),
          .off = number_of_json(json.at("off")),
          .farthest = json.at("farthest"),
          .error = number_of_json(json.at("error")),
          .caveats = json.at("caveats")};
}

}  // namespace

Json trial_json(const MonteCarloTrial& trial) {
  Json json = {{"seed", trial.seed},
               {"parameters", trial.parameters},
               {"bound", numbers_json(trial.bound)},
               {"bound_with_steps", numbers_json(trial.bound_with_steps)},
               {"refined", estimate_json(trial.refined)}};
  if (trial.rqe) json["rqe"] = estimate_json(*trial.rqe);
  return json;
}

MonteCarloTrial trial_of(const Json& json) {
  MonteCarloTrial trial{.seed = json.at("seed"),
                        .parameters = json.at("parameters"),
                        .bound = vector_of(json.at("bound")),
                        .bound_with_steps = vector_of(json.at("bound_with_steps")),
                        .rqe = {},
                        .refined = estimate_of(json.at("refined"))};
  if (json.contains("rqe")) trial.rqe = estimate_of(json["rqe"]);
  return trial;
}

Json basin_json(const BasinRecording& recording) {
  Json starts = Json::array();
  for (const auto& start : recording.starts) starts.push_back(start_json(start));
  return {{"seed", recording.seed},
          {"parameters", recording.parameters},
          {"starts", std::move(starts)},
          {"caveats", recording.caveats},
          {"failure", recording.failure}};
}

BasinRecording basin_of(const Json& json) {
  BasinRecording recording{.seed = json.at("seed"),
                           .parameters = json.at("parameters"),
                           .starts = {},
                           .caveats = json.at("caveats"),
                           .failure = json.at("failure")};
  for (const auto& start : json.at("starts")) recording.starts.push_back(start_of(start, recording.seed));
  return recording;
}

}  // namespace crisp::study
