// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <limits>
#include <unordered_map>

#include <crisp/error.hpp>

#include "pipeline/batch/ledger.hpp"
#include "pipeline/batch/table.hpp"
#include "pipeline/files/folder_lock.hpp"

namespace crisp::batch {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

/// Numbers that are not finite are null in JSON.
double number_of(const Json& json) {
  return json.is_number() ? json.get<double>() : std::numeric_limits<double>::quiet_NaN();
}

void take_results(const Json& results, BatchRow& row) {
  if (results.contains("error")) row.reasons.push_back(results["error"]);
  if (results.contains("reasons")) {
    for (const auto& reason : results["reasons"]) row.reasons.push_back(reason);
  }
  if (results.contains("begin")) row.begin = results["begin"];
  if (results.contains("points")) row.points = results["points"];
  if (results.contains("quality")) {
    for (const auto& [name, value] : results["quality"].items()) row.quality[name] = number_of(value);
  }
  if (results.contains("parameters")) {
    for (const auto& [name, parameter] : results["parameters"].items()) {
      RowParameter& own = row.parameters[name];
      own.value = number_of(parameter.at("value"));
      own.unit = parameter.at("unit");
      if (parameter.contains("std_error")) own.std_error = number_of(parameter["std_error"]);
    }
  }
  if (results.contains("causes")) {
    for (const auto& cause : results["causes"])
      row.causes.push_back(cause.at("cause").get<std::string>() + " of " +
                           cause.at("scope").get<std::string>());
  }
}

BatchRow row_of(const Json& end) {
  BatchRow row{.name = end.at("name"), .status = end.at("status"), .ended = end.at("time")};
  row.seconds = end.value("seconds", 0.0);
  row.cpu_seconds = end.value("cpu", 0.0);
  row.memory = end.value("memory", std::uint64_t{0});
  for (const auto& file : end.value("input", Json::array()))
    row.input_bytes += file.at("bytes").get<std::uint64_t>();
  take_results(end.value("results", Json::object()), row);
  return row;
}

class RowReader {
 public:
  void read(const fs::path& manifest) {
    rows_.damaged_lines += read_manifest(manifest, [&](BatchEvent&& event, std::string_view line) {
      try {
        take(std::move(event), line, manifest.parent_path().native());
      } catch (const Json::exception&) {  // the rest of the line is none that a batch writes
        ++rows_.damaged_lines;
      }
    });
  }

  BatchRows finish() {
    for (const auto& [name, state] : ledger_.all()) {
      BatchRow row = ends_.contains(name) ? std::move(ends_[name]) : BatchRow{.name = name};
      const DueReason reason = due_reason(&state, rows_.settings);
      if (reason == DueReason::half_done) {
        row.status = is_running(state.started_by) ? "running" : "due";
        row.reasons.clear();
        if (row.status == "due") row.reasons.emplace_back("it was incomplete when its batch ended");
      }
      if (reason == DueReason::retry || reason == DueReason::settings || reason == DueReason::fresh)
        row.status = "due";
      if (reason == DueReason::settings) row.reasons.emplace_back("it was processed with other settings");
      rows_.rows.push_back(std::move(row));
    }
    std::ranges::sort(rows_.rows, {}, &BatchRow::name);
    return std::move(rows_);
  }

 private:
  /// Whether the task has its lock.
  bool is_running(std::string_view task) {
    const auto [known, is_new] = running_.try_emplace(task);
    if (is_new) known->second = files::FolderLock::holder_of(task).has_value();
    return known->second;
  }

  void take(BatchEvent&& event, std::string_view line, std::string_view task) {
    if (event.kind == BatchEventKind::batch) {
      if (event.time < last_batch_) return;
      last_batch_ = event.time;
      rows_.batch = Json::parse(line);
      rows_.settings = event.settings;
      rows_.recordings = rows_.batch.value("recordings", std::size_t{0});
      return;
    }
    if (event.kind == BatchEventKind::end && is_last_end(event))
      ends_[event.name] = row_of(Json::parse(line));
    ledger_.add(std::move(event), task);
  }

  bool is_last_end(const BatchEvent& event) const {
    const RecordingState* state = ledger_.find(event.name);
    return !state || event.time >= state->ended;
  }

  BatchLedger ledger_;
  std::unordered_map<std::string, BatchRow> ends_;
  std::map<std::string_view, bool> running_;  ///< by the task's folder
  std::int64_t last_batch_ = 0;
  BatchRows rows_;
};

}  // namespace

std::size_t BatchRows::count(std::string_view status) const {
  return static_cast<std::size_t>(std::ranges::count(rows, status, &BatchRow::status));
}

BatchRows read_rows(const fs::path& output) {
  const auto manifests = manifests_of(output);
  if (manifests.empty())
    throw Error(output.string() + " is no output folder of a batch: it holds no manifest",
                "give the folder of crisp batch -o");
  RowReader reader;
  for (const auto& manifest : manifests) reader.read(manifest);
  return reader.finish();
}

}  // namespace crisp::batch
