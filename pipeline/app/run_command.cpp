// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <tbb/global_control.h>
#include <unistd.h>

#include <csignal>
#include <iostream>

#include "pipeline/app/commands.hpp"
#include "pipeline/app/metrics_server.hpp"
#include "pipeline/app/progress.hpp"
#include "pipeline/app/run_record.hpp"
#include "pipeline/app/signals.hpp"
#include "pipeline/app/status_board.hpp"
#include "pipeline/app/summary.hpp"
#include "pipeline/app/terminal.hpp"
#include "pipeline/data/all_errors.hpp"
#include "pipeline/files/atomic_file.hpp"
#include "pipeline/files/folder_lock.hpp"
#include "pipeline/files/utc_now.hpp"
#include "pipeline/pcd/parts.hpp"
#include "pipeline/stage/files_written.hpp"
#include "pipeline/stage/reference.hpp"

namespace crisp {
namespace {

namespace fs = std::filesystem;

/// What was cut into several files is called by the name that they come of.
void check_input(const std::optional<fs::path>& input) {
  if (!input) return;
  std::error_code failure;
  if (fs::exists(*input, failure)) return;
  if (failure) throw Error("the input " + input->string() + " cannot be read: " + failure.message());
  if (!fs::exists(part_path(*input, 1), failure)) throw Error("there is no input " + input->string());
}

RunRecord begin_record(const LoadedPipeline& loaded, const RunSettings& run) {
  RunRecord record;
  record.pipeline_file = loaded.file;
  record.rig_file = loaded.rig_file;
  record.seed = run.seed;
  record.threads = run.threads;
  record.started = utc_now();
  for (const auto& node : loaded.pipeline.nodes) record.options.push_back(effective_options(node));
  return record;
}

std::vector<std::string> tags_of(const Pipeline& pipeline) {
  std::vector<std::string> tags;
  for (const auto& node : pipeline.nodes) tags.push_back(node.tag);
  return tags;
}

/// The pipeline is gone when this returns or throws, and with it what is left of files that are not complete:
/// on a full disk the run's records need the room.
std::vector<NodeResult> run_with_progress(Pipeline pipeline, const RunSettings& run,
                                          const RunRequest& request, RunRecord& record) {
  StatusBoard board(tags_of(pipeline));
  std::optional<MetricsServer> metrics;
  if (request.metrics) metrics.emplace(*request.metrics, [&board] { return board.prometheus(); });
  ProgressPrinter printer(std::cerr, isatty(STDERR_FILENO) == 1, seconds_now, terminal_width());
  std::optional<StopNotice> notice;
  if (!request.quiet) notice.emplace(std::cerr);
  RunHooks hooks{.stop = StopOnSignal::flag()};
  hooks.failed = [&](std::vector<NodeResult> until_then) { record.nodes = std::move(until_then); };
  if (!request.quiet || metrics) {
    hooks.status = [&](const std::string& tag, const StageStatus& status) {
      board.tell(tag, status);
      if (request.quiet) return;
      for (const auto& event : status.events) printer.log(fmt::format("{} {}: {}", utc_now(), tag, event));
      printer.show_status(board.line());
    };
  }
  if (!request.quiet) {
    hooks.progress = [&](const std::string& tag, const Progress& progress) { printer.show(tag, progress); };
  }
  return run_pipeline(pipeline, run, hooks);
}

/// Whether another process writes into the output folder, because it took this one for dead.
bool has_lost_folder(const FolderLock* lock, const fs::path& folder) {
  if (!lock || !lock->is_lost()) return false;
  print_errors(Error("another process has taken over the folder " + folder.string() +
                         ", as this one gave no sign of life for too long: the files there may be of either",
                     "run it anew, with another folder"));
  return true;
}

/// Each part is tried though another failed: a summary without the rest still says what happened.
/// @return whether all of it could be written
bool keep_record(RunRecord& record, const fs::path& folder, const FolderLock* lock) {
  if (has_lost_folder(lock, folder)) return false;
  bool all_kept = true;
  const auto keep = [&](const auto& part) {
    for_each_error(part, [&](const Error& error) {
      print_errors(error);
      all_kept = false;
      if (!record.failure.empty()) return;
      record.failure = error_text(error);
      record.exit_status = static_cast<int>(ExitStatus::failed);
    });
  };
  if (record.failure.empty() || record.wrote_any()) keep([&] { record.inputs = hash_inputs(record); });
  keep([&] { write_provenance(record); });
  keep([&] { write_summary(record, folder); });
  return all_kept;
}

ExitStatus status_of(int signal) {
  if (signal == SIGHUP) return ExitStatus::hung_up;
  return signal == SIGTERM ? ExitStatus::terminated : ExitStatus::interrupted;
}

ExitStatus run_loaded(LoadedPipeline loaded, const RunRequest& request, const RunSettings& run,
                      const FolderLock* lock) {
  const StopOnSignal stop;
  RunRecord record = begin_record(loaded, run);
  const double began = seconds_now();
  const auto end_early = [&](std::string why, ExitStatus status) {
    record.seconds = seconds_now() - began;
    record.failure = std::move(why);
    record.exit_status = static_cast<int>(status);
    keep_record(record, run.output, lock);
    return status;
  };
  try {
    record.nodes = run_with_progress(std::move(loaded.pipeline), run, request, record);
  } catch (const Interrupted&) {
    std::cerr << "interrupted: files that were not complete were not written\n";
    return end_early("interrupted", status_of(StopOnSignal::signal()));
  } catch (const Error& error) {
    std::cerr << failure_text(record);
    print_errors(error);
    return end_early(error_text(error), ExitStatus::failed);
  }
  record.seconds = seconds_now() - began;
  // Before the records, for which a disk that became full has no room.
  if (request.quiet)
    std::cerr << warnings_text(record);
  else
    std::cout << summary_text(record, request.verbose) << std::flush;
  const ExitStatus status = record.is_trusted() ? ExitStatus::done : ExitStatus::not_trusted;
  record.exit_status = static_cast<int>(status);
  return keep_record(record, run.output, lock) ? status : ExitStatus::failed;
}

}  // namespace

ExitStatus run_command(const RunRequest& request, const Registrar& registrar) {
  // For good: what nobody read is written once more when the program ends.
  std::signal(SIGPIPE, SIG_IGN);
  RunSettings run;
  run.registrar = &registrar;
  run.threads = request.threads;
  run.seed = request.seed;
  std::optional<LoadedPipeline> loaded;
  std::unique_ptr<FolderLock> lock;
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism,
                                  std::max(1U, request.threads));
  try {
    loaded = request.text.empty() ? load_pipeline(request.file, request.arguments, run)
                                  : load_pipeline(request.text, request.file, request.arguments, run);
    check_input(request.arguments.input);
    // Finds out before the work, and not after it, that nothing can be written there.
    if (!run.output.empty()) {
      lock = std::make_unique<FolderLock>(run.output);
      remove_left_over_parts(run.output);
      // It speaks of what an earlier run wrote, and must not stay beside what this one writes.
      std::error_code not_there;
      fs::remove(run.output / kSummary, not_there);
    }
    print_warnings(loaded->pipeline);
  } catch (const Error& error) {
    print_errors(error);
    return ExitStatus::misused;
  }
  return run_loaded(std::move(*loaded), request, run, lock.get());
}

}  // namespace crisp
