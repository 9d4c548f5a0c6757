// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/app/recorded_run.hpp"

#include <system_error>
#include <utility>

#include <crisp/atomic_file.hpp>
#include <crisp/error.hpp>

#include "pipeline/app/terminal.hpp"
#include "pipeline/files/process_identity.hpp"
#include "pipeline/files/utc_now.hpp"
#include "pipeline/pcd/parts.hpp"
#include "pipeline/stage/files_written.hpp"
#include "pipeline/stage/reference.hpp"

namespace crisp::app {
namespace {

namespace fs = std::filesystem;

/// Parts of a split file are named by their base name.
void check_input(const std::optional<fs::path>& input) {
  if (!input) return;
  std::error_code failure;
  if (fs::exists(*input, failure)) return;
  if (failure)
    throw Error("the input " + input->string() + " cannot be read: " + failure.message(),
                "check its path and its permissions");
  if (!fs::exists(pcd::part_path(*input, 1), failure))
    throw Error("there is no input " + input->string(), "check the name after -i");
}

RunSettings run_settings_of(const RunRequest& request, const Registrar& registrar) {
  RunSettings settings;
  settings.registrar = &registrar;
  settings.threads = request.threads;
  settings.seed = request.seed;
  return settings;
}

LoadedPipeline load(const RunRequest& request, RunSettings& settings) {
  return request.text.empty() ? load_pipeline(request.file, request.arguments, settings)
                              : load_pipeline(request.text, request.file, request.arguments, settings);
}

}  // namespace

RecordedRun::RecordedRun(const RunRequest& request, const Registrar& registrar)
    : settings_(run_settings_of(request, registrar)), loaded_(load(request, settings_)) {
  check_input(request.arguments.input);
  // Checks before the work, and not after it, that the folder is writable.
  if (!settings_.output.empty()) {
    lock_ = std::make_unique<files::FolderLock>(settings_.output);
    remove_left_over_parts(settings_.output);
    // The file describes an earlier run and must not remain next to this run's files.
    std::error_code not_there;
    fs::remove(settings_.output / stage::kSummary, not_there);
  }
  record_.command = files::command_of_this_process();
  record_.pipeline_file = loaded_.file;
  record_.rig_file = loaded_.rig_file;
  record_.seed = settings_.seed;
  record_.threads = settings_.threads;
  record_.started = files::utc_now();
  for (const auto& node : loaded_.pipeline.nodes) record_.options.push_back(stage::effective_options(node));
}

void RecordedRun::run(RunHooks hooks) {
  Pipeline pipeline = std::move(loaded_.pipeline);
  const double began = seconds_now();
  hooks.failed = [&](std::vector<NodeResult> until_then) {
    record_.nodes = std::move(until_then);
    record_.seconds = seconds_now() - began;
  };
  record_.nodes = run_pipeline(pipeline, settings_, hooks);
  record_.seconds = seconds_now() - began;
}

/// Whether another process writes into the output folder, because it took this one for dead.
bool RecordedRun::has_lost_folder(const std::function<void(const Error&)>& report) const {
  if (!lock_ || !lock_->is_lost()) return false;
  report(Error("another process has taken over the folder " + settings_.output.string() +
                   ", since this one sent no heartbeat for too long: its files may be of either process",
               "run again with another folder"));
  return true;
}

bool RecordedRun::keep(const std::function<void(const Error&)>& report) {
  if (has_lost_folder(report)) return false;
  bool all_kept = true;
  const auto keep = [&](const auto& part) {
    for_each_error(part, [&](const Error& error) {
      report(error);
      all_kept = false;
      if (!record_.failure.empty()) return;
      record_.failure = error_text(error);
      record_.exit_status = static_cast<int>(ExitStatus::failed);
    });
  };
  if (record_.failure.empty() || record_.wrote_any()) keep([&] { record_.inputs = hash_inputs(record_); });
  if (record_.failure.empty()) keep([&] { write_when_recorded(record_); });
  keep([&] { write_provenance(record_); });
  keep([&] { write_summary(record_, settings_.output); });
  return all_kept;
}

}  // namespace crisp::app
