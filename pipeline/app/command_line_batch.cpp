// SPDX-License-Identifier: BSD-3-Clause
// The commands of batches, on one machine and on a cluster.
#include "pipeline/app/command_line.hpp"
#include "pipeline/app/own_process.hpp"
#include "pipeline/app/whole_number.hpp"

namespace crisp {
namespace {

constexpr const char* kJobThreads = "How many threads each job may use";

}  // namespace

void CommandLine::add_batch() {
  batch_app = command(
      "batch", "Run a pipeline over many recordings, each in a process of its own; go on where it stopped");
  add_pipeline(batch_app, batch.run.file);
  add_batch_inputs(batch_app, batch);
  batch.jobs = own_cores();
  batch_app->add_option("--jobs", batch.jobs, "How many recordings to process at once")
      ->check(whole_number(1, 4096))
      ->capture_default_str();
  batch_app->add_option("--shard", batch.shard, "Only the i-th of n parts of the recordings")
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
        "Recordings: files, folders, quoted patterns ('captures/**/*.pcap'), a list NAME.txt, or - for "
        "a list on the standard input (may be repeated)")
      ->type_name("PATH");
  to->add_option("-o,--output", request.output, "The folder for the results, a folder in it a recording")
      ->type_name("FOLDER");
  to->add_option("--each", request.each, "What is one recording: each file, or the captures of each folder")
      ->check(CLI::IsMember({"file", "folder"}))
      ->capture_default_str();
  to->add_option("--base", request.base, "The folder that the names of the results are relative to")
      ->type_name("FOLDER");
  to->add_option(
        "--rig", request.rig,
        "The rig, instead of the one that the pipeline names; {folder}, {stem} and {name} are those of "
        "the recording: '{folder}/rig.yaml'")
      ->type_name("FILE");
  add_set(to, request.run.arguments);
}

void CommandLine::add_batch_limits(CLI::App* to, BatchRequest& request) {
  to->add_option("--timeout", request.timeout, "End a job that takes longer: 90s, 10min")->type_name("TIME");
  to->add_option("--memory", request.memory,
                 "Run no more jobs at once than fit into so much memory, by what they were seen to take: 8GB")
      ->transform(CLI::AsSizeValue(true))
      ->type_name("SIZE");
}

void CommandLine::add_cluster() {
  cluster_app = command("cluster", "Run a batch on a cluster, by its scheduler Slurm");
  cluster_app->require_subcommand(1);
  ClusterSubmitRequest& request = cluster_submit;
  CLI::App* submit = cluster_app->add_subcommand(
      "submit", "Submit a batch as an array of tasks, and a job after them that writes the table");
  submit->fallthrough();
  add_pipeline(submit, request.batch.run.file)->required();
  add_batch_inputs(submit, request.batch);
  submit->get_option("--input")->required();
  submit->get_option("--output")->required();
  submit->add_option("--tasks", request.tasks, "Into how many parts; each should have minutes of work")
      ->check(whole_number(1, 1000000))
      ->required();
  submit->add_option("--cpus", request.cpus, "Cores of each task, and so recordings at once")
      ->check(whole_number(1, 4096))
      ->capture_default_str();
  add_batch_limits(submit, request.batch);
  add_threads_and_seed(submit, "--threads", request.batch.run);
  submit->get_option("--threads")->description(kJobThreads);
  submit
      ->add_option("--sbatch", request.sbatch,
                   "Another option of sbatch, without dashes: partition=long (may be repeated)")
      ->type_name("NAME=VALUE")
      ->allow_extra_args(false);
  submit->add_flag("--dry-run", request.dry_run, "Print the scripts and commands, and submit nothing");
  submit->add_flag("--wait", request.wait, "Wait for the end, and have the exit status of the whole batch");
}

void CommandLine::add_batch_verbs() {
  const auto verb = [this](const std::string& name, const std::string& help, std::filesystem::path& folder) {
    CLI::App* made = batch_app->add_subcommand(name, help);
    made->add_option("folder", folder, "The batch's output folder")->required()->type_name("FOLDER");
    made->fallthrough();
    return made;
  };
  batch_status_app = verb("status", "Print what is done, running, failed, and why", batch_status.folder);
  batch_status_app->add_flag("--watch", batch_status.watch, "Again every two seconds until nothing is due");
  batch_status_app->add_flag("--json", batch_status.json, "For programs");
  batch_table_app =
      verb("table", "Write and print the table, a row a recording, from all manifests", batch_table.folder);
  batch_table_app->add_flag("--json", batch_table.json, "As JSON");
  batch_retry_app = verb("retry", "Run the batch again, with what failed before", batch_retry.folder);
  batch_retry_app->add_option("--match", batch_retry.match, "Only recordings of such names: 'site3/*'")
      ->type_name("PATTERN");
  batch_retry_app->add_flag("--mark", batch_retry.mark, "Leave them to the next crisp batch");
}

}  // namespace crisp
