// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <csignal>
#include <iostream>
#include <thread>

#include <crisp/atomic_file.hpp>

#include "pipeline/app/batch_commands.hpp"
#include "pipeline/app/batch_preparation.hpp"
#include "pipeline/app/batch_progress.hpp"
#include "pipeline/app/batch_report.hpp"
#include "pipeline/app/signals.hpp"
#include "pipeline/batch/output_name.hpp"
#include "pipeline/data/counted.hpp"
#include "pipeline/files/folder_lock.hpp"

namespace crisp::app {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

/// A job of a batch that was killed a moment ago may still be about to end.
void wait_for_the_dying(const fs::path& output) {
  constexpr std::chrono::milliseconds kPollEvery{20};
  constexpr int kTurns = 100;
  for (int i = 0; i < kTurns && files::FolderLock::holder_of(output); ++i)
    std::this_thread::sleep_for(kPollEvery);
}

std::string host_name() {
  std::array<char, 256> name{};
  gethostname(name.data(), name.size() - 1);
  return name.data();
}

std::string task_of(const batch::Shard& shard) {
  return shard.is_whole() ? "batch" : fmt::format("shard-{}-of-{}", shard.number, shard.count);
}

/// Waits while another process has the part: a scheduler starts a task again whose node gives no sign of
/// life, though the task may live on there.
void lock_task(const fs::path& task, const batch::Shard& shard, std::optional<files::FolderLock>& lock) {
  constexpr std::chrono::seconds kTryEvery{1};
  bool waits = false;
  while (!lock) {
    try {
      lock.emplace(task);
    } catch (const Error& error) {
      if (shard.is_whole() || !files::FolderLock::is_refusal(error.message())) throw;
      if (!waits) std::cerr << "waiting for part " << shard.text() << ": " << error.message() << "\n";
      waits = true;
      std::this_thread::sleep_for(kTryEvery);
    }
  }
}

void begin(const BatchRequest& request, const PreparedBatch& batch, batch::ManifestWriter& manifest) {
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
  manifest.append(batch::BatchEventKind::batch, event);
  for (const auto& touched : batch.plan.touched)
    manifest.append(batch::BatchEventKind::same,
                    {{"name", touched.name}, {"input", batch::to_json(touched.files)}});
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

ExitStatus run_prepared(const BatchRequest& request, const PreparedBatch& batch, batch::JobLauncher& launcher,
                        batch::ManifestWriter& manifest, const files::FolderLock& lock,
                        const Registrar& registrar) {
  const StopOnSignal stop;
  batch::BatchOutcome outcome;
  {
    BatchDisplay display(request.run.quiet, request.run.metrics);
    std::optional<StopNotice> notice;
    if (!request.run.quiet) notice.emplace(std::cerr);
    const batch::BatchLimits limits{
        .jobs = request.jobs,
        .timeout = batch.timeout,
        .memory = request.memory > 0 ? std::optional(request.memory) : std::nullopt};
    batch::BatchHooks hooks = display.hooks(StopOnSignal::flag());
    hooks.is_lost = [&lock] { return lock.is_lost(); };
    outcome =
        batch::run_batch(batch.plan.due, request.output, batch.digest, limits, launcher, manifest, hooks);
  }
  if (lock.is_lost()) {
    print_errors(
        Error("another process has taken over this batch, since this one sent no heartbeat for too long",
              "see crisp batch status"));
    return ExitStatus::failed;
  }
  if (!outcome.full_disk.empty()) {
    print_errors(Error("the disk is full, so the batch stopped: " + outcome.full_disk,
                       "then run the batch again: it continues where it stopped"));
    return ExitStatus::failed;
  }
  if (*StopOnSignal::flag()) {
    std::cerr << fmt::format("interrupted: {} of {} ended; run the batch again to continue\n",
                             outcome.progress.ended(), data::counted(outcome.progress.total, "recording"));
    return status_of_stop();
  }
  BatchTally tally{.done = outcome.progress.done,
                   .untrusted = outcome.progress.untrusted,
                   .failed = outcome.progress.failed};
  tally.add(batch.plan.kept);
  if (batch.shard.is_whole())
    write_results(request.output, registrar, request.run.quiet ? nullptr : &std::cout);
  else if (!request.run.quiet)
    std::cout << fmt::format("shard {}: {}\n", batch.shard.text(), in_words(tally));
  return tally.exit_status();
}

}  // namespace

ExitStatus batch_command(const BatchRequest& request, const Registrar& registrar) {
  std::signal(SIGPIPE, SIG_IGN);  // as crisp run does
  // First of all, while the process is small and has one thread.
  batch::JobLauncher launcher([&](const batch::Job& job) {
    wait_for_the_dying(job.output);
    return static_cast<int>(run_command(run_of(request, job), registrar));
  });
  std::optional<PreparedBatch> batch;
  std::optional<files::FolderLock> lock;
  std::optional<batch::ManifestWriter> manifest;
  try {
    const batch::Shard shard = shard_of(request);
    const fs::path task = batch::task_folder(request.output, task_of(shard));
    batch = check_batch(request, shard, registrar);
    lock_task(task, shard, lock);
    remove_left_over_parts(request.output);
    plan_due(request, *batch);
    if (batch->is_over(request.output)) return report_nothing_due(request, *batch);
    manifest.emplace(task / batch::kManifestFile);
    begin(request, *batch, *manifest);
  } catch (const Error& error) {
    print_errors(error);
    return ExitStatus::misused;
  }
  return run_prepared(request, *batch, launcher, *manifest, *lock, registrar);
}

}  // namespace crisp::app
