// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/batch/job_results.hpp"

#include <fstream>
#include <system_error>
#include <vector>

#include <crisp/calibration_file.hpp>
#include <crisp/error.hpp>

#include "pipeline/files/findings_file.hpp"
#include "pipeline/files/renamed_names.hpp"
#include "pipeline/stage/files_written.hpp"

namespace crisp::batch {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

Json parameter_json(const Parameter& parameter) {
  Json json = {{"value", parameter.value}, {"unit", parameter.unit}};
  if (parameter.free) json["std_error"] = parameter.std_error;
  return json;
}

void add_terms(const std::string& owner, const std::vector<TermParameters>& terms, Json& parameters) {
  for (const auto& term : terms) {
    for (const auto& parameter : term.parameters)
      parameters[owner + "." + term.term + "." + parameter.name] = parameter_json(parameter);
  }
}

void add_calibration(const fs::path& file, Json& results) {
  const Calibration calibration = read_calibration(file);
  Json& parameters = results["parameters"] = Json::object();
  for (const auto& laser : calibration.lasers) {
    for (const auto* parameter : {&laser.lambda, &laser.tau, &laser.alpha, &laser.eta})
      parameters[laser.name + "." + parameter->name] = parameter_json(*parameter);
    add_terms(laser.name, laser.terms, parameters);
  }
  add_terms("plate", calibration.plate_terms, parameters);
  for (const auto& [name, value] : calibration.quality) results["quality"][name] = value;
}

void add_findings(const fs::path& file, Json& results) {
  Json& causes = results["causes"] = Json::array();
  for (const auto& finding : files::read_findings(file).findings) {
    if (finding.accepted) causes.push_back({{"cause", finding.cause}, {"scope", finding.scope}});
  }
}

void add_stage(const Json& stage, Json& results) {
  const std::string name = stage.at("stage");
  const auto written = stage.at("outputs").get<std::vector<std::string>>();
  if (name == "write.calibration" && !written.empty()) add_calibration(written.front(), results);
  if (name == "write.findings" && !written.empty()) add_findings(written.front(), results);
  const Json& report = stage.at("report");
  if (report.contains("points") && report["points"].is_number()) results["points"] = report["points"];
  if (!results.contains("begin") && report.contains("first") && report["first"].is_number())
    results["begin"] = report["first"];
  for (const auto& caveat : stage.at("caveats"))
    results["reasons"].push_back(stage.at("tag").get<std::string>() + ": " + caveat.get<std::string>());
}

void read_summary(Json summary, JobResults& results) {
  files::rename_old_keys(summary, "summary");
  if (summary.contains("error")) results.json["error"] = summary["error"];
  for (const auto& input : summary.at("inputs")) results.sha256[input.at("file")] = input.at("sha256");
  for (const auto& stage : summary.at("stages")) {
    try {
      add_stage(stage, results.json);
    } catch (const Error& error) {
      results.json["reasons"].push_back(error.what());
    }
  }
}

}  // namespace

JobResults read_results(const fs::path& output) {
  JobResults results;
  std::ifstream stream(output / stage::kSummary);
  if (!stream) return results;
  try {
    read_summary(Json::parse(stream), results);
  } catch (const std::exception& error) {  // stated by the summary, or thrown while reading it
    results.json["reasons"].push_back((output / stage::kSummary).string() +
                                      " cannot be read: " + error.what());
  }
  return results;
}

void remove_summary(const fs::path& output) {
  std::error_code none;
  fs::remove(output / stage::kSummary, none);
}

}  // namespace crisp::batch
