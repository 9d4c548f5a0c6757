// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/app/batch_preparation.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cstdlib>
#include <iostream>

#include <crisp/registrar.hpp>

#include "pipeline/app/batch_report.hpp"
#include "pipeline/batch/effective_settings.hpp"
#include "pipeline/batch/last_batch.hpp"
#include "pipeline/batch/slurm_environment.hpp"
#include "pipeline/data/counted.hpp"
#include "pipeline/files/quantity.hpp"

namespace crisp::app {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

std::optional<double> timeout_of(const BatchRequest& request) {
  if (request.timeout.empty()) return std::nullopt;
  const auto read = files::parse_quantity(request.timeout, "s");
  if (const auto* wrong = std::get_if<files::Complaint>(&read))
    throw Error("--timeout: " + wrong->text, "write it like 90s or 600");
  const double seconds = std::get<double>(read);
  if (seconds > 0) return seconds;
  throw Error("--timeout: " + request.timeout + " is not above 0 s", "omit it for no limit");
}

/// The extensions of files that are recordings, and not results of one.
std::vector<std::string> recording_extensions(const Registrar& registrar) {
  std::vector<std::string> extensions = {".csv"};
  for (const auto& inspector : registrar.inspectors())
    extensions.insert(extensions.end(), inspector.extensions.begin(), inspector.extensions.end());
  return extensions;
}

std::vector<batch::BatchInput> recordings_of(const BatchRequest& request, const Registrar& registrar) {
  auto recordings = batch::find_recordings(
      {.given = request.inputs,
       .unit = request.each == "folder" ? batch::BatchUnit::folder : batch::BatchUnit::file,
       .base = request.base,
       .output = request.output,
       .extensions = recording_extensions(registrar)});
  if (recordings.empty())
    throw Error("there is no recording in the inputs of -i",
                "captures end in .pcap or .pcapng, clouds in .pcd");
  return recordings;
}

LoadedPipeline load_for(const BatchRequest& request, const batch::Job& job, const Registrar& registrar) {
  RunSettings run;
  run.registrar = &registrar;
  return load_pipeline(request.run.file, run_of(request, job).arguments, run);
}

/// The rig of the first recording that has one: what a pipeline is checked with before anything runs.
fs::path any_rig(const BatchRequest& request, const std::vector<batch::BatchInput>& recordings) {
  if (!has_rig_each(request)) return {};
  std::error_code none;
  for (const auto& recording : recordings) {
    fs::path rig = rig_path(request.rig, recording);
    if (fs::exists(rig, none)) return rig;
  }
  throw Error("no recording has a rig at " + request.rig, "check the pattern of --rig");
}

/// Checks the pipeline, and finds all that the results depend on.
Json settings_of(const BatchRequest& request, const std::vector<batch::BatchInput>& recordings,
                 const Registrar& registrar) {
  const fs::path rig = any_rig(request, recordings);
  auto one = load_for(request, {.name = "${name}", .input = "/${input}", .output = "/${output}", .rig = rig},
                      registrar);
  print_warnings(one.pipeline);
  batch::check_depends_on_recording(
      one,
      load_for(request, {.name = "name", .input = "/input", .output = "/output", .rig = rig}, registrar));
  if (!has_rig_each(request)) return batch::effective_settings(one, request.run.seed);
  one.rig_file.clear();  // each recording's is part of its input
  Json settings = batch::effective_settings(one, request.run.seed);
  settings["rig"] = request.rig;
  return settings;
}

void print_plan(const fs::path& output, const batch::BatchPlan& plan, const Json& settings,
                std::ostream& out) {
  for (const auto& [reason, count] : plan.reasons) {
    if (reason == batch::DueReason::fresh) continue;
    out << fmt::format("due again, since {}: {} ({}{})\n", in_words(reason),
                       data::counted(count, "recording"), plan.examples.at(reason), count > 1 ? ", …" : "");
    if (reason != batch::DueReason::settings) continue;
    const Json before = batch::last_batch(output);
    if (before.contains("effective"))
      out << fmt::format("  {}\n",
                         fmt::join(batch::changes_of_settings(before["effective"], settings), "\n  "));
  }
  std::size_t kept = 0;
  for (const auto& [status, count] : plan.kept) kept += count;
  if (kept > 0) out << fmt::format("{} already done and unchanged\n", data::counted(kept, "recording"));
  const auto failed = plan.kept.find(batch::JobStatus::failed);
  if (failed != plan.kept.end())
    out << fmt::format("  {} of them failed; crisp batch retry repeats them\n", failed->second);
}

}  // namespace

bool PreparedBatch::is_over(const fs::path& output) const {
  return plan.due.empty() && plan.touched.empty() && (!shard.is_whole() || are_tables_current(output));
}

RunRequest run_of(const BatchRequest& request, const batch::Job& job) {
  RunRequest run = request.run;
  run.arguments.input = job.input;
  run.arguments.output = job.output;
  run.arguments.name = job.name;
  if (!job.rig.empty())
    run.arguments.rig = job.rig;
  else if (!request.rig.empty())
    run.arguments.rig = request.rig;
  run.quiet = true;
  run.verbose = false;
  run.metrics.reset();
  return run;
}

batch::Shard shard_of(const BatchRequest& request) {
  if (!request.shard.empty()) return batch::parse_shard(request.shard);
  const auto variable = [](const char* name) -> const char* { return std::getenv(name); };
  return batch::shard_of_slurm(variable).value_or(batch::Shard{});
}

PreparedBatch check_batch(const BatchRequest& request, const batch::Shard& shard,
                          const Registrar& registrar) {
  PreparedBatch batch{.shard = shard, .timeout = timeout_of(request)};
  batch.recordings = recordings_of(request, registrar);
  batch.total = batch.recordings.size();
  batch.settings = settings_of(request, batch.recordings, registrar);
  batch.digest = batch::digest_of_settings(batch.settings);
  std::erase_if(batch.recordings,
                [&](const batch::BatchInput& recording) { return !shard.has(recording.name); });
  return batch;
}

void plan_due(const BatchRequest& request, PreparedBatch& batch) {
  const auto has = [&](std::string_view name) { return batch.shard.has(name); };
  const auto ledger = batch::BatchLedger::read(request.output, has);
  const auto rig_of = [&](const batch::BatchInput& input) {
    return has_rig_each(request) ? rig_path(request.rig, input) : fs::path();
  };
  batch.plan = batch::plan_batch(std::move(batch.recordings), ledger, batch.digest, rig_of);
  if (request.run.quiet) return;
  print_plan(request.output, batch.plan, batch.settings, std::cerr);
  if (ledger.damaged_lines() > 0)
    std::cerr << fmt::format("warning: {} of the manifests are damaged and were skipped\n",
                             data::counted(ledger.damaged_lines(), "line"));
}

}  // namespace crisp::app
