// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/app/cluster_command.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <iostream>
#include <optional>

#include <crisp/atomic_file.hpp>

#include "pipeline/app/batch_preparation.hpp"
#include "pipeline/app/captured_output.hpp"
#include "pipeline/app/own_process.hpp"
#include "pipeline/batch/manifest.hpp"
#include "pipeline/batch/slurm_script.hpp"
#include "pipeline/data/counted.hpp"
#include "pipeline/files/folder_lock.hpp"

namespace crisp::app {
namespace {

namespace fs = std::filesystem;
using SlurmOptions = std::vector<std::pair<std::string, std::string>>;

/// The jobs to submit: an array of tasks, and the job after them.
struct ClusterPlan {
  std::uint64_t tasks = 0;
  fs::path folder;  ///< of scripts and logs
  std::string batch;
  std::string merge;

  fs::path batch_script() const { return folder / "batch.sbatch"; }
  fs::path merge_script() const { return folder / "merge.sbatch"; }
};

/// Nothing if Slurm does not answer.
std::optional<std::uint64_t> query_longest_array() {
  try {
    const auto config = capture_output({"scontrol", "show", "config"});
    return config.status == 0 ? batch::longest_slurm_array(config.text) : std::nullopt;
  } catch (const Error&) {
    return std::nullopt;
  }
}

/// The requested number of tasks, or fewer if the site or the number of recordings limits it.
std::uint64_t number_of_tasks(std::uint64_t requested, std::uint64_t recordings) {
  std::uint64_t tasks = requested;
  if (tasks > recordings) {
    tasks = recordings;
    std::cerr << fmt::format("{} instead of {}: there are no more recordings\n", data::counted(tasks, "task"),
                             requested);
  }
  const auto most = query_longest_array();
  if (!most) {
    std::cerr << "warning: scontrol did not report Slurm's MaxArraySize; if it is not above " << tasks
              << ", sbatch will refuse the array\n";
  } else if (tasks > *most) {
    tasks = *most;
    std::cerr << fmt::format("{} instead of {}, each with more recordings: the site's MaxArraySize is {}\n",
                             data::counted(tasks, "task"), requested, *most + 1);
  }
  return tasks;
}

void refuse_standard_input(const BatchRequest& request) {
  if (std::ranges::find(request.inputs, "-") == request.inputs.end()) return;
  throw Error("tasks of a cluster cannot read the standard input",
              "write the recordings into a file NAME.txt, and give it after -i");
}

/// Tasks of an earlier submission would only keep those of this one waiting.
void refuse_running(const fs::path& output) {
  for (const auto& manifest : batch::manifests_of(output)) {
    const auto holder = files::FolderLock::holder_of(manifest.parent_path());
    if (!holder) continue;
    throw Error(
        fmt::format("{} of this batch is running: {}", manifest.parent_path().filename().string(), *holder),
        "wait for it (crisp batch status --watch), or end it (scancel)");
  }
}

std::pair<std::string, std::string> split_option(const std::string& option) {
  const std::size_t begin = option.find_first_not_of('-');
  if (begin == std::string::npos)
    throw Error("--sbatch: '" + option + "' is no option", "write partition=long");
  const std::size_t equals = option.find('=');
  if (equals == std::string::npos) return {option.substr(begin), ""};
  return {option.substr(begin, equals - begin), option.substr(equals + 1)};
}

SlurmOptions options_of(const ClusterSubmitRequest& request, const std::string& log) {
  SlurmOptions options = {{"chdir", fs::current_path().string()}, {"output", log}};
  for (const auto& option : request.sbatch) options.push_back(split_option(option));
  return options;
}

std::vector<std::string> words_of(const ClusterSubmitRequest& request) {
  auto words = batch_words(request.batch);
  for (const auto& plugin : request.plugins) words.insert(words.end(), {"--plugin", plugin});
  return words;
}

ClusterPlan plan(const ClusterSubmitRequest& request, std::uint64_t recordings) {
  ClusterPlan plan{
      .tasks = number_of_tasks(request.tasks, recordings),
      .folder = fs::absolute(batch::task_folder(request.batch.output, "slurm")).lexically_normal()};
  const std::string log = batch::slurm_log_path((plan.folder / "task").string());
  auto options = options_of(request, log + "-%A_%a.log");
  options.insert(options.begin(), {{"array", fmt::format("1-{}", plan.tasks)},
                                   {"cpus-per-task", std::to_string(request.cpus)}});
  const std::string program = own_file().string();
  plan.batch = batch::complete_slurm_script(
      batch::kSlurmBatchScript,
      {.options = std::move(options), .program = program, .words = words_of(request)});
  plan.merge = batch::complete_slurm_script(
      batch::kSlurmMergeScript,
      {.options = options_of(request, batch::slurm_log_path((plan.folder / "merge").string()) + "-%j.log"),
       .program = program,
       .words = {request.batch.output.string()}});
  return plan;
}

std::vector<std::string> batch_submission(const ClusterPlan& plan) {
  return {"sbatch", "--parsable", plan.batch_script().string()};
}

std::vector<std::string> merge_submission(const ClusterPlan& plan, const std::string& job, bool wait) {
  std::vector<std::string> words = {"sbatch", "--parsable", "--dependency=afterany:" + job};
  if (wait) words.emplace_back("--wait");
  words.push_back(plan.merge_script().string());
  return words;
}

void print(const ClusterPlan& plan, bool wait) {
  std::cout << plan.batch_script().string() << ":\n\n"
            << plan.batch << "\n"
            << plan.merge_script().string() << ":\n\n"
            << plan.merge << "\n"
            << fmt::format("job=$({})\n{}\n", fmt::join(batch_submission(plan), " "),
                           fmt::join(merge_submission(plan, "$job", wait), " "));
}

/// The job's number, of "12" or "12;cluster".
std::string job_of(const std::string& printed) { return printed.substr(0, printed.find_first_of(";\n")); }

std::string submit_array(const ClusterPlan& plan) {
  try {
    const auto sbatch = capture_output(batch_submission(plan));
    if (sbatch.status == 0) return job_of(sbatch.text);
  } catch (const Error& error) {
    throw Error(
        error.message(),
        "run the command where Slurm's programs are installed, or inspect the scripts with --dry-run");
  }
  throw Error("sbatch refused " + plan.batch_script().string(), "its message is above; see --sbatch");
}

ExitStatus submit(const ClusterPlan& plan, const ClusterSubmitRequest& request) {
  fs::create_directories(plan.folder);
  write_file(plan.batch_script(), plan.batch);
  write_file(plan.merge_script(), plan.merge);
  const std::string job = submit_array(plan);
  std::cout << fmt::format("job {}: {}\n", job, data::counted(plan.tasks, "task")) << std::flush;
  const auto merge = capture_output(merge_submission(plan, job, request.wait));
  const std::string merge_job = job_of(merge.text);
  if (merge_job.empty())
    throw Error("sbatch refused " + plan.merge_script().string(),
                "run crisp batch table when the array has ended, or end the array: scancel " + job);
  std::cout << fmt::format("job {}: the table, after them\nlogs: {}\n", merge_job, plan.folder.string());
  if (request.wait) return static_cast<ExitStatus>(merge.status);
  std::cout << fmt::format("crisp batch status {} reports their progress\n",
                           batch::bash_quoted(request.batch.output.string()));
  return ExitStatus::done;
}

}  // namespace

ExitStatus cluster_submit_command(const ClusterSubmitRequest& request, const Registrar& registrar) {
  ClusterPlan planned;
  try {
    refuse_standard_input(request.batch);
    const auto batch = check_batch(request.batch, batch::Shard{}, registrar);
    refuse_running(request.batch.output);
    planned = plan(request, batch.total);
  } catch (const Error& error) {
    print_errors(error);
    return ExitStatus::misused;
  }
  if (!request.dry_run) return submit(planned, request);
  print(planned, request.wait);
  return ExitStatus::done;
}

}  // namespace crisp::app
