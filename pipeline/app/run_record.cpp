// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/app/run_record.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <system_error>
#include <utility>

#include <crisp/atomic_file.hpp>
#include <crisp/error.hpp>

#include "pipeline/files/json_text.hpp"
#include "pipeline/stage/files_written.hpp"

namespace crisp::app {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

Json inputs_json(const RunRecord& record) {
  Json list = Json::array();
  for (const auto& input : record.inputs) {
    list.push_back(
        {{"file", input.file.string()}, {"bytes", input.digest.bytes}, {"sha256", input.digest.sha256}});
  }
  return list;
}

/// The head of summaries and provenance records.
Json head_json(const RunRecord& record) {
  return {{"crisp", CRISP_VERSION},
          {"command", record.command},
          {"pipeline", record.pipeline_file.string()},
          {"rig", record.rig_file.empty() ? "default" : record.rig_file.string()},
          {"seed", record.seed},
          {"threads", record.threads},
          {"started", record.started},
          {"seconds", record.seconds},
          {"inputs", inputs_json(record)}};
}

/// A stage's entry in the summary and in the provenance records.
Json stage_json(const RunRecord& record, std::size_t i) {
  const NodeResult& node = record.nodes[i];
  return {
      {"tag", node.tag}, {"stage", node.stage}, {"seconds", node.seconds}, {"options", record.options[i]}};
}

Json outputs_json(const StageReport& report) {
  Json list = Json::array();
  for (const auto& file : report.written) list.push_back(file.string());
  return list;
}

std::string dump(const Json& json) {
  // Texts from files may hold anything; what is no UTF-8 is replaced instead of throwing.
  return files::json_text(json, 2) + "\n";
}

/// The stage that wrote this file; nullptr if none did.
const NodeResult* writer_of(const fs::path& file, const RunRecord& record) {
  const auto wrote = [&](const NodeResult& node) {
    return std::ranges::find(node.report.written, file) != node.report.written.end();
  };
  const auto writer = std::ranges::find_if(record.nodes, wrote);
  return writer == record.nodes.end() ? nullptr : &*writer;
}

/// Not in the place of what a stage wrote and did not declare.
void write_record(const fs::path& file, const Json& json, const RunRecord& record) {
  if (const NodeResult* writer = writer_of(file, record)) {
    throw Error(
        fmt::format("{}: it wrote {}, which is the name of the run's own record", writer->tag, file.string()),
        "let it write another file");
  }
  write_file(file, dump(json));
}

}  // namespace

bool RunRecord::is_trusted() const {
  return failure.empty() && std::all_of(nodes.begin(), nodes.end(),
                                        [](const auto& node) { return node.report.caveats.empty(); });
}

bool RunRecord::wrote_any() const {
  return std::any_of(nodes.begin(), nodes.end(),
                     [](const auto& node) { return !node.report.written.empty(); });
}

std::vector<InputRecord> hash_inputs(const RunRecord& record) {
  std::vector<fs::path> files = {record.pipeline_file};
  if (!record.rig_file.empty()) files.push_back(record.rig_file);
  for (const auto& node : record.nodes) {
    files.insert(files.end(), node.report.read.begin(), node.report.read.end());
  }
  std::vector<InputRecord> inputs;
  for (auto& file : files) {
    file = fs::absolute(file).lexically_normal();
    const auto same = [&](const InputRecord& input) { return input.file == file; };
    std::error_code failure;
    if (!fs::is_regular_file(file, failure) || std::any_of(inputs.begin(), inputs.end(), same)) continue;
    inputs.push_back({file, files::digest_of(file)});
  }
  return inputs;
}

Json summary_json(const RunRecord& record) {
  Json json = head_json(record);
  json["trusted"] = record.is_trusted();
  json["exit_status"] = record.exit_status;
  if (!record.failure.empty()) json["error"] = record.failure;
  json["stages"] = Json::array();
  for (std::size_t i = 0; i < record.nodes.size(); ++i) {
    const NodeResult& node = record.nodes[i];
    Json stage = stage_json(record, i);
    stage.update({{"taken", node.taken},
                  {"given", node.given},
                  {"counts", node.report.counts},
                  {"warnings", node.report.warnings},
                  {"caveats", node.report.caveats},
                  {"outputs", outputs_json(node.report)},
                  {"report", node.report.section}});
    json["stages"].push_back(std::move(stage));
  }
  return json;
}

Json provenance_json(const RunRecord& record, const fs::path& file) {
  Json json = {{"file", file.filename().string()}};
  json.update(head_json(record));
  json["trusted"] = record.is_trusted();
  if (!record.failure.empty()) json["failure"] = record.failure;
  json["stages"] = Json::array();
  for (std::size_t i = 0; i < record.nodes.size(); ++i) {
    json["stages"].push_back(stage_json(record, i));
  }
  return json;
}

void write_when_recorded(RunRecord& record) {
  AllErrors errors;
  const Json summary = summary_json(record);
  for (auto& node : record.nodes) {
    if (!node.report.when_recorded) continue;
    const auto written = std::exchange(node.report.written, {});
    errors.keep_of([&] {
      node.report.when_recorded(summary);
      node.report.written = written;
    });
  }
  errors.throw_any();
}

void write_provenance(const RunRecord& record) {
  AllErrors errors;
  for (const auto& node : record.nodes) {
    for (const auto& file : node.report.written) {
      errors.keep_of(
          [&] { write_record(file.string() + kProvenance, provenance_json(record, file), record); });
    }
  }
  errors.throw_any();
}

void write_summary(const RunRecord& record, const fs::path& folder) {
  if (folder.empty()) return;
  write_record(folder / stage::kSummary, summary_json(record), record);
}

}  // namespace crisp::app
