// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <tbb/global_control.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <iostream>
#include <optional>

#include "pipeline/app/commands.hpp"
#include "pipeline/app/metrics_server.hpp"
#include "pipeline/app/progress.hpp"
#include "pipeline/app/recorded_run.hpp"
#include "pipeline/app/signals.hpp"
#include "pipeline/app/status_board.hpp"
#include "pipeline/app/summary.hpp"
#include "pipeline/app/terminal.hpp"
#include "pipeline/files/utc_now.hpp"

namespace crisp::app {
namespace {

std::vector<std::string> tags_of(const Pipeline& pipeline) {
  std::vector<std::string> tags;
  for (const auto& node : pipeline.nodes) tags.push_back(node.tag);
  return tags;
}

void run_with_progress(RecordedRun& run, const RunRequest& request) {
  StatusBoard board(tags_of(run.pipeline()));
  std::optional<MetricsServer> metrics;
  if (request.metrics) metrics.emplace(*request.metrics, [&board] { return board.prometheus(); });
  ProgressPrinter printer(std::cerr, isatty(STDERR_FILENO) == 1, seconds_now, terminal_width());
  std::optional<StopNotice> notice;
  if (!request.quiet) notice.emplace(std::cerr);
  RunHooks hooks{.stop = StopOnSignal::flag()};
  if (!request.quiet || metrics) {
    hooks.status = [&](const std::string& tag, const StageStatus& status) {
      board.set_status(tag, status);
      if (request.quiet) return;
      for (const auto& event : status.events)
        printer.log(fmt::format("{} {}: {}", files::utc_now(), tag, event));
      printer.show_status(board.line());
    };
  }
  if (!request.quiet) {
    hooks.progress = [&](const std::string& tag, const Progress& progress) { printer.show(tag, progress); };
    hooks.caveat = [&](const std::string& tag, const std::string& caveat) {
      printer.log(fmt::format("untrusted so far (a later stage may resolve it): {}: {}", tag, caveat));
    };
  }
  run.run(std::move(hooks));
}

ExitStatus status_of(int signal) {
  if (signal == SIGHUP) return ExitStatus::hung_up;
  return signal == SIGTERM ? ExitStatus::terminated : ExitStatus::interrupted;
}

ExitStatus run_loaded(RecordedRun& run, const RunRequest& request) {
  const StopOnSignal stop;
  RunRecord& record = run.record();
  const auto end_early = [&](std::string why, ExitStatus status) {
    record.failure = std::move(why);
    record.exit_status = static_cast<int>(status);
    run.keep(print_errors);
    return status;
  };
  try {
    run_with_progress(run, request);
  } catch (const Interrupted&) {
    std::cerr << "interrupted: incomplete files were not written\n";
    return end_early("interrupted", status_of(StopOnSignal::signal()));
  } catch (const Error& error) {
    std::cerr << failure_text(record);
    print_errors(error);
    return end_early(error_text(error), ExitStatus::failed);
  }
  // Before the records, for which a disk that became full has no room.
  if (request.quiet)
    std::cerr << warnings_text(record);
  else
    std::cout << summary_text(record, request.verbose) << std::flush;
  const ExitStatus status = record.is_trusted() ? ExitStatus::done : ExitStatus::not_trusted;
  record.exit_status = static_cast<int>(status);
  return run.keep(print_errors) ? status : ExitStatus::failed;
}

}  // namespace

ExitStatus run_command(const RunRequest& request, const Registrar& registrar) {
  // For good: what nobody read is written once more when the program ends.
  std::signal(SIGPIPE, SIG_IGN);
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism,
                                  std::max(1U, request.threads));
  std::optional<RecordedRun> run;
  try {
    run.emplace(request, registrar);
    print_warnings(run->pipeline());
  } catch (const Error& error) {
    print_errors(error);
    return ExitStatus::misused;
  }
  return run_loaded(*run, request);
}

}  // namespace crisp::app
