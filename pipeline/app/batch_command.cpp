// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <iostream>
#include <thread>

#include "pipeline/app/batch_commands.hpp"
#include "pipeline/app/batch_progress.hpp"
#include "pipeline/app/batch_report.hpp"
#include "pipeline/app/signals.hpp"
#include "pipeline/batch/effective_settings.hpp"
#include "pipeline/batch/last_batch.hpp"
#include "pipeline/batch/output_name.hpp"
#include "pipeline/batch/plan.hpp"
#include "pipeline/batch/shard.hpp"
#include "pipeline/data/counted.hpp"
#include "pipeline/files/folder_lock.hpp"
#include "pipeline/files/quantity.hpp"
#include "pipeline/stage/inspector.hpp"

namespace crisp {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

RunRequest run_of(const BatchRequest& request, const Job& job) {
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

/// A job of a batch that was killed a moment ago may still be about to end.
void wait_for_the_dying(const fs::path& output) {
  constexpr std::chrono::milliseconds kAskEvery{20};
  constexpr int kTurns = 100;
  for (int i = 0; i < kTurns && FolderLock::holder_of(output); ++i) std::this_thread::sleep_for(kAskEvery);
}

std::optional<double> timeout_of(const BatchRequest& request) {
  if (request.timeout.empty()) return std::nullopt;
  const auto read = parse_quantity(request.timeout, "s");
  if (const auto* wrong = std::get_if<Complaint>(&read)) throw Error("--timeout: " + wrong->text);
  const double seconds = std::get<double>(read);
  if (seconds > 0) return seconds;
  throw Error("--timeout: " + request.timeout + " is not above 0 s", "leave it away for no limit");
}

Shard shard_of(const BatchRequest& request) {
  if (!request.shard.empty()) return parse_shard(request.shard);
  const auto variable = [](const char* name) -> const char* { return std::getenv(name); };
  return shard_of_slurm(variable).value_or(Shard{});
}

/// The extensions of files that are recordings, and not results of one.
std::vector<std::string> recording_extensions(const Registrar& registrar) {
  std::vector<std::string> extensions = {".csv"};
  for (const auto& inspector : registrar.inspectors())
    extensions.insert(extensions.end(), inspector.extensions.begin(), inspector.extensions.end());
  return extensions;
}

std::vector<BatchInput> recordings_of(const BatchRequest& request, const Registrar& registrar) {
  auto recordings = find_recordings({.given = request.inputs,
                                     .unit = request.each == "folder" ? BatchUnit::folder : BatchUnit::file,
                                     .base = request.base,
                                     .output = request.output,
                                     .extensions = recording_extensions(registrar)});
  if (recordings.empty())
    throw Error("there is no recording in what -i names", "captures end in .pcap or .pcapng, clouds in .pcd");
  return recordings;
}

LoadedPipeline load_for(const BatchRequest& request, const Job& job, const Registrar& registrar) {
  RunSettings run;
  run.registrar = &registrar;
  return load_pipeline(request.run.file, run_of(request, job).arguments, run);
}

/// The rig of the first recording that has one: what a pipeline is checked with before anything runs.
fs::path any_rig(const BatchRequest& request, const std::vector<BatchInput>& recordings) {
  if (!has_rig_each(request)) return {};
  std::error_code none;
  for (const auto& recording : recordings) {
    fs::path rig = rig_path(request.rig, recording);
    if (fs::exists(rig, none)) return rig;
  }
  throw Error("no recording has a rig at " + request.rig, "check the pattern of --rig");
}

/// Checks the pipeline, and finds all that the results depend on.
Json settings_of(const BatchRequest& request, const std::vector<BatchInput>& recordings,
                 const Registrar& registrar) {
  const fs::path rig = any_rig(request, recordings);
  auto one = load_for(request, {.name = "${name}", .input = "/${input}", .output = "/${output}", .rig = rig},
                      registrar);
  print_warnings(one.pipeline);
  check_depends_on_recording(
      one,
      load_for(request, {.name = "name", .input = "/input", .output = "/output", .rig = rig}, registrar));
  if (!has_rig_each(request)) return effective_settings(one, request.run.seed);
  one.rig_file.clear();  // each recording's is part of its input
  Json settings = effective_settings(one, request.run.seed);
  settings["rig"] = request.rig;
  return settings;
}

void print_plan(const fs::path& output, const BatchPlan& plan, const Json& settings, std::ostream& out) {
  for (const auto& [reason, count] : plan.reasons) {
    if (reason == DueReason::fresh) continue;
    out << fmt::format("due again, as {}: {} ({}{})\n", in_words(reason), counted(count, "recording"),
                       plan.examples.at(reason), count > 1 ? ", …" : "");
    if (reason != DueReason::settings) continue;
    const Json before = last_batch(output);
    if (before.contains("effective"))
      out << fmt::format("  {}\n", fmt::join(changes_of_settings(before["effective"], settings), "\n  "));
  }
  std::size_t kept = 0;
  for (const auto& [status, count] : plan.kept) kept += count;
  if (kept > 0) out << fmt::format("{} done before and unchanged\n", counted(kept, "recording"));
  const auto failed = plan.kept.find(JobStatus::failed);
  if (failed != plan.kept.end())
    out << fmt::format("  {} of them failed; crisp batch retry tries them again\n", failed->second);
}

std::string host_name() {
  std::array<char, 256> name{};
  gethostname(name.data(), name.size() - 1);
  return name.data();
}

std::string task_of(const Shard& shard) {
  return shard.is_whole() ? "batch" : fmt::format("shard-{}-of-{}", shard.number, shard.count);
}

/// What a batch needs once everything about it is known to be right.
struct PreparedBatch {
  Shard shard;
  std::optional<double> timeout;
  std::size_t total = 0;               ///< how many recordings there are in all shards
  std::vector<BatchInput> recordings;  ///< of this shard, until they are planned
  Json settings;
  std::string digest;
  BatchPlan plan;

  /// Whether there is nothing to do and nothing to write.
  bool is_over(const fs::path& output) const {
    return plan.due.empty() && plan.touched.empty() && (!shard.is_whole() || are_tables_current(output));
  }
};

/// All that can be found wrong before the output folder is touched.
PreparedBatch check(const BatchRequest& request, const Shard& shard, const Registrar& registrar) {
  PreparedBatch batch{.shard = shard, .timeout = timeout_of(request)};
  batch.recordings = recordings_of(request, registrar);
  batch.total = batch.recordings.size();
  batch.settings = settings_of(request, batch.recordings, registrar);
  batch.digest = digest_of_settings(batch.settings);
  std::erase_if(batch.recordings, [&](const BatchInput& recording) { return !shard.has(recording.name); });
  return batch;
}

/// A task that was requeued may come before the lease of the one that died on another machine is over.
void lock_task(const fs::path& task, const Shard& shard, std::optional<FolderLock>& lock) {
  const FolderLockSettings settings;
  const auto give_up = std::chrono::steady_clock::now() + 2 * settings.lease;
  constexpr std::chrono::seconds kTryEvery{1};
  while (!lock) {
    try {
      lock.emplace(task, settings);
    } catch (const Error&) {
      if (shard.is_whole() || std::chrono::steady_clock::now() > give_up) throw;
      std::this_thread::sleep_for(kTryEvery);
    }
  }
}

/// To be called while no other process has the lock of the task.
void plan(const BatchRequest& request, PreparedBatch& batch) {
  const auto has = [&](std::string_view name) { return batch.shard.has(name); };
  const auto ledger = BatchLedger::read(request.output, has);
  const auto rig_of = [&](const BatchInput& input) {
    return has_rig_each(request) ? rig_path(request.rig, input) : fs::path();
  };
  batch.plan = plan_batch(std::move(batch.recordings), ledger, batch.digest, rig_of);
  if (request.run.quiet) return;
  print_plan(request.output, batch.plan, batch.settings, std::cerr);
  if (ledger.damaged_lines() > 0)
    std::cerr << fmt::format("warning: {} of the manifests are damaged and were passed over\n",
                             counted(ledger.damaged_lines(), "line"));
}

void begin(const BatchRequest& request, const PreparedBatch& batch, ManifestWriter& manifest) {
  Json event = {{"settings", batch.digest},
                {"crisp", CRISP_VERSION},
                {"pipeline", request.run.file.string()},
                {"host", host_name()},
                {"process", getpid()},
                {"shard", batch.shard.text()},
                {"recordings", batch.total},
                {"due", batch.plan.due.size()},
                {"jobs", request.jobs},
                {"arguments", arguments_json(request)},
                {"effective", batch.settings}};
  manifest.append(BatchEventKind::batch, event);
  for (const auto& touched : batch.plan.touched)
    manifest.append(BatchEventKind::same, {{"name", touched.name}, {"input", to_json(touched.files)}});
  manifest.sync();
}

ExitStatus report_nothing_due(const BatchRequest& request, const PreparedBatch& batch) {
  BatchTally tally;
  tally.add(batch.plan.kept);
  if (!request.run.quiet) std::cout << "nothing is due: " << in_words(tally) << "\n";
  return tally.exit_status();
}

ExitStatus status_of_stop() {
  switch (StopOnSignal::signal()) {
    case SIGHUP:
      return ExitStatus::hung_up;
    case SIGTERM:
      return ExitStatus::terminated;
    default:
      return ExitStatus::interrupted;
  }
}

ExitStatus run_prepared(const BatchRequest& request, const PreparedBatch& batch, JobLauncher& launcher,
                        ManifestWriter& manifest, const FolderLock& lock) {
  const StopOnSignal stop;
  BatchOutcome outcome;
  {
    BatchDisplay display(request.run.quiet, request.run.metrics);
    std::optional<StopNotice> notice;
    if (!request.run.quiet) notice.emplace(std::cerr);
    const BatchLimits limits{.jobs = request.jobs,
                             .timeout = batch.timeout,
                             .memory = request.memory > 0 ? std::optional(request.memory) : std::nullopt};
    BatchHooks hooks = display.hooks(StopOnSignal::flag());
    hooks.is_lost = [&lock] { return lock.is_lost(); };
    outcome = run_batch(batch.plan.due, request.output, batch.digest, limits, launcher, manifest, hooks);
  }
  if (lock.is_lost()) {
    print_errors(
        Error("another process has taken over this batch, as this one gave no sign of life for too long",
              "see crisp batch status"));
    return ExitStatus::failed;
  }
  if (!outcome.full_disk.empty()) {
    print_errors(Error("the disk is full, so the batch stopped: " + outcome.full_disk,
                       "make room and run the batch again: it goes on where it stopped"));
    return ExitStatus::failed;
  }
  if (*StopOnSignal::flag()) {
    std::cerr << fmt::format("interrupted: {} of {} ended; run the batch again to go on\n",
                             outcome.progress.ended(), counted(outcome.progress.total, "recording"));
    return status_of_stop();
  }
  BatchTally tally{.done = outcome.progress.done,
                   .untrusted = outcome.progress.untrusted,
                   .failed = outcome.progress.failed};
  tally.add(batch.plan.kept);
  if (batch.shard.is_whole())
    write_tables(request.output, request.run.quiet ? nullptr : &std::cout);
  else if (!request.run.quiet)
    std::cout << fmt::format("shard {}: {}\n", batch.shard.text(), in_words(tally));
  return tally.exit_status();
}

}  // namespace

ExitStatus batch_command(const BatchRequest& request, const Registrar& registrar) {
  std::signal(SIGPIPE, SIG_IGN);  // as crisp run does
  // First of all, while the process is small and has one thread.
  JobLauncher launcher([&](const Job& job) {
    wait_for_the_dying(job.output);
    return static_cast<int>(run_command(run_of(request, job), registrar));
  });
  std::optional<PreparedBatch> batch;
  std::optional<FolderLock> lock;
  std::optional<ManifestWriter> manifest;
  try {
    const Shard shard = shard_of(request);
    const fs::path task = task_folder(request.output, task_of(shard));
    batch = check(request, shard, registrar);
    lock_task(task, shard, lock);
    plan(request, *batch);
    if (batch->is_over(request.output)) return report_nothing_due(request, *batch);
    manifest.emplace(task / kManifestFile);
    begin(request, *batch, *manifest);
  } catch (const Error& error) {
    print_errors(error);
    return ExitStatus::misused;
  }
  return run_prepared(request, *batch, launcher, *manifest, *lock);
}

}  // namespace crisp
