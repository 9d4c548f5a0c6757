// SPDX-License-Identifier: BSD-3-Clause
// The commands of batches, on one machine and on a cluster.
#include "pipeline/app/command_line.hpp"
#include "pipeline/app/own_process.hpp"
#include "pipeline/app/whole_number.hpp"

namespace crisp::app {
namespace {

constexpr const char* kJobThreads = "Number of threads per job";

}  // namespace

void CommandLine::add_batch() {
  batch_app = command(
      "batch",
      "Run a pipeline over many recordings, each in a process of its own; resumes an interrupted batch");
  add_pipeline(batch_app, batch.run.file);
  add_batch_inputs(batch_app, batch);
  batch.jobs = own_cores();
  batch_app->add_option("--jobs", batch.jobs, "Number of concurrent jobs")
      ->check(whole_number(1, 4096))
      ->capture_default_str();
  batch_app->add_option("--shard", batch.shard, "Process only the i-th of n parts of the recordings")
      ->type_name("i/n");
  add_batch_limits(batch_app, batch);
  add_run_options(batch_app, "--threads", batch.run);
  batch.run.threads = 1;
  batch_app->get_option("--threads")->description(kJobThreads)->capture_default_str();
  add_batch_verbs();
}

void CommandLine::add_batch_inputs(CLI::App* to, BatchRequest& request) {
  to->add_option(
        "-i,--input", request.inputs,
        "Recordings: files, folders, quoted patterns ('captures/**/*.pcap'), a list NAME.txt, or - for a list on the standard input (may be repeated)")
      ->type_name("PATH");
  to->add_option("-o,--output", request.output, "Folder for the results, with a subfolder for each recording")
      ->type_name("FOLDER");
  to->add_option("--each", request.each, "A recording is each file, or the captures of each folder")
      ->check(CLI::IsMember({"file", "folder"}))
      ->capture_default_str();
  to->add_option("--base", request.base, "Base folder of the results' relative names")->type_name("FOLDER");
  to->add_option(
        "--rig", request.rig,
        "Rig file; overrides the one that the pipeline names; {folder}, {stem} and {name} are the recording's: '{folder}/rig.yaml'")
      ->type_name("FILE");
  add_set(to, request.run.arguments);
}

void CommandLine::add_batch_limits(CLI::App* to, BatchRequest& request) {
  to->add_option("--timeout", request.timeout, "Time limit of a job: 90s, 10min")->type_name("TIME");
  to->add_option("--memory", request.memory,
                 "Memory limit of all concurrent jobs, by their measured use: 8GB")
      ->transform(CLI::AsSizeValue(true))
      ->type_name("SIZE");
}

void CommandLine::add_cluster() {
  cluster_app = command("cluster", "Run a batch on a cluster, by its scheduler Slurm");
  cluster_app->require_subcommand(1);
  ClusterSubmitRequest& request = cluster_submit;
  CLI::App* submit = cluster_app->add_subcommand(
      "submit", "Submit a batch as a job array, with a final job that writes the table");
  submit->fallthrough();
  add_pipeline(submit, request.batch.run.file)->required();
  add_batch_inputs(submit, request.batch);
  submit->get_option("--input")->required();
  submit->get_option("--output")->required();
  submit->add_option("--tasks", request.tasks, "Number of tasks; each should have minutes of work")
      ->check(whole_number(1, 1000000))
      ->required();
  submit
      ->add_option("--cpus", request.cpus,
                   "Cores of each task, which process as many recordings concurrently")
      ->check(whole_number(1, 4096))
      ->capture_default_str();
  add_batch_limits(submit, request.batch);
  add_threads_and_seed(submit, "--threads", request.batch.run);
  submit->get_option("--threads")->description(kJobThreads);
  submit
      ->add_option("--sbatch", request.sbatch,
                   "Further option of sbatch, without dashes: partition=long (repeatable)")
      ->type_name("NAME=VALUE")
      ->allow_extra_args(false);
  submit->add_flag("--dry-run", request.dry_run, "Print the scripts and commands, and submit nothing");
  submit->add_flag("--wait", request.wait, "Wait for the end; exit with the status of the whole batch");
}

void CommandLine::add_batch_verbs() {
  const auto verb = [this](const std::string& name, const std::string& help, std::filesystem::path& folder) {
    CLI::App* made = batch_app->add_subcommand(name, help);
    made->add_option("folder", folder, "Output folder of the batch")->required()->type_name("FOLDER");
    made->fallthrough();
    return made;
  };
  batch_status_app =
      verb("status", "Print the number of done, running and failed recordings, and the failures",
           batch_status.folder);
  batch_status_app->add_flag("--watch", batch_status.watch, "Repeat every two seconds until nothing is due");
  batch_status_app->add_flag("--json", batch_status.json, "For programs");
  batch_table_app = verb("table", "Write and print the table, one row per recording, from all manifests",
                         batch_table.folder);
  batch_table_app->add_flag("--json", batch_table.json, "As JSON");
  batch_retry_app = verb("retry", "Run the batch again, failed recordings included", batch_retry.folder);
  batch_retry_app
      ->add_option("--match", batch_retry.match, "Only recordings that match the pattern: 'site3/*'")
      ->type_name("PATTERN");
  batch_retry_app->add_flag("--mark", batch_retry.mark, "Only mark them; the next crisp batch runs them");
}

}  // namespace crisp::app
