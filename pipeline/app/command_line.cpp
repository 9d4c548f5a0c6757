// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/app/command_line.hpp"

#include <algorithm>
#include <charconv>
#include <limits>

#include "pipeline/app/installed_pipelines.hpp"
#include "pipeline/app/own_pipelines.hpp"
#include "pipeline/app/own_process.hpp"
#include "pipeline/app/usage_error.hpp"

namespace crisp {
namespace {

constexpr const char* kFooter =
    "Exit status: 0 done; 1 a run stopped at an error; 2 the command line, the pipeline or the rig is wrong "
    "and\n"
    "nothing was run; 3 the run came to its end but its result cannot be trusted (the summary says why);\n"
    "129, 130 or 143 interrupted. Plugins are also loaded from <libdir>/crisp/plugins, and from the "
    "files\nand "
    "folders that CRISP_PLUGINS lists.";

constexpr const char* kScenes = "What stands around: office, hall, street, workshop, garden, people or paper";

constexpr const char* kJobThreads = "How many threads each job may use";

constexpr const char* kPipeline = "The pipeline's YAML file, or the name of an installed one";

CLI::Validator whole_number(std::uint64_t least, std::uint64_t most) {
  const std::string range = std::to_string(least) + " to " + std::to_string(most);
  const auto refuse = [=](const std::string& text) -> std::string {
    std::uint64_t number = 0;
    const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (failure != std::errc::result_out_of_range &&
        (failure != std::errc() || end != text.data() + text.size()))
      return "'" + text + "' is not a whole number, " + range;
    if (failure == std::errc() && number >= least && number <= most) return {};
    return text + " is not from " + range;
  };
  return CLI::Validator(refuse, "", "whole_number");
}

}  // namespace

CommandLine::CommandLine() {
  app.set_version_flag("--version", "crisp " CRISP_VERSION);
  app.footer(kFooter);
  app.require_subcommand(1);
  app.failure_message(
      [](const CLI::App* asked, const CLI::Error& error) { return usage_error(*asked, error); });
  add_run();
  calibrate_app =
      add_of_recording("calibrate", "Find where the lasers sit and when they measure, and make the cloud",
                       kCalibratePipeline, calibrate);
  diagnose_app = add_of_recording("diagnose", "Find by name what the sensor model lacks, and what it costs",
                                  kDiagnosePipeline, diagnose);
  add_batch();
  add_cluster();
  add_record();
  add_emulate();
  add_report();
  add_convert();
  add_bound();
  add_basin();
  add_monte_carlo();
  add_figures();
  add_validate();
  add_stages();
  add_effects();
  plugins_app = command("plugins", "List the plugins that were tried, and why any were refused");
  add_info();
  completion_app = command("completion", "Print a script that completes crisp's command line");
  completion_app->add_option("shell", shell, "The shell")->required()->check(CLI::IsMember({"bash"}));
}

CLI::App* CommandLine::command(const std::string& name, const std::string& help) {
  CLI::App* made = app.add_subcommand(name, help);
  made->add_option("--plugin", plugins, "Load this plugin, or those of this folder (may be repeated)")
      ->type_name("PATH")
      ->allow_extra_args(false);
  return made;
}

void CommandLine::add_arguments(CLI::App* to, PipelineArguments& arguments) {
  to->add_option("-i,--input", arguments.input, "What ${input} stands for")->type_name("PATH");
  to->add_option("-o,--output", arguments.output, "The folder that ${output} stands for")
      ->type_name("FOLDER");
  add_rig(to, arguments);
  add_set(to, arguments);
}

void CommandLine::add_rig(CLI::App* to, PipelineArguments& arguments) {
  to->add_option("--rig", arguments.rig, "The rig, instead of the one that the pipeline names")
      ->type_name("FILE");
}

void CommandLine::add_set(CLI::App* to, PipelineArguments& arguments) {
  to->add_option("--set", arguments.set,
                 "An option of a stage, tag.option=value, or a variable, name=value (may be repeated)")
      ->type_name("NAME=VALUE")
      ->allow_extra_args(false);
}

CLI::Option* CommandLine::add_pipeline(CLI::App* to, std::filesystem::path& file, const std::string& help) {
  const auto find = [](std::string& text) -> std::string {
    try {
      text = pipelines_of_program().find(text).string();
      return {};
    } catch (const Error& error) {
      return error.message() + "; " + error.advice();
    }
  };
  return to->add_option("pipeline", file, help)
      ->transform(CLI::Validator(find, "", "installed_pipeline"))
      ->type_name("PIPELINE");
}

CLI::App* CommandLine::add_of_recording(const char* name, const std::string& help, std::string_view text,
                                        RunRequest& request) {
  CLI::App* made = command(name, help);
  made->add_option("recording", request.arguments.input, "A capture, or a folder of captures of one scanner")
      ->required()
      ->type_name("PATH");
  add_own_pipeline(made, (std::string(name) + ".yaml").c_str(), text, std::filesystem::path("out") / name,
                   "--threads", request);
  add_rig(made, request.arguments);
  return made;
}

void CommandLine::add_run() {
  run_app = command("run", "Run a pipeline");
  add_pipeline(run_app, run.file, kPipeline)->required();
  add_arguments(run_app, run.arguments);
  add_run_options(run_app, "--threads", run);
}

void CommandLine::add_batch() {
  batch_app = command(
      "batch", "Run a pipeline over many recordings, each in a process of its own; go on where it stopped");
  add_pipeline(batch_app, batch.run.file, kPipeline);
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
  add_pipeline(submit, request.batch.run.file, kPipeline)->required()->type_name("FILE");
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

void CommandLine::add_threads_and_seed(CLI::App* to, const std::string& threads, RunRequest& request) {
  to->add_option(threads, request.threads, "How many threads to use; the result does not depend on it")
      ->check(whole_number(1, 1024))
      ->capture_default_str();
  to->add_option("--seed", request.seed, "Seed of all that is drawn at random")
      ->check(whole_number(0, std::numeric_limits<std::uint64_t>::max()))
      ->capture_default_str();
}

void CommandLine::add_run_options(CLI::App* to, const std::string& threads, RunRequest& request) {
  request.threads = own_cores();
  add_threads_and_seed(to, threads, request);
  to->add_option("--metrics", request.metrics,
                 "While it runs, tell how it is doing at http://127.0.0.1:PORT/metrics, for Prometheus")
      ->check(whole_number(1, 65535))
      ->type_name("PORT");
  CLI::Option* quiet = to->add_flag("--quiet", request.quiet, "Print warnings and errors only");
  to->add_flag("--verbose", request.verbose, "Also print options and what flowed")->excludes(quiet);
}

void CommandLine::add_own_pipeline(CLI::App* to, const char* name, std::string_view text,
                                   const std::filesystem::path& output, const std::string& threads,
                                   RunRequest& request) {
  request.file = name;
  request.text = text;
  request.arguments.output = output;
  to->add_option("-o,--output", request.arguments.output,
                 "The folder for the results [" + output.string() + "]")
      ->type_name("FOLDER");
  add_set(to, request.arguments);
  add_run_options(to, threads, request);
}

void CommandLine::add_stage_options(
    CLI::App* to, const std::string& stage, RunRequest& request,
    std::initializer_list<std::pair<std::string, std::string>> names_and_help) {
  for (const auto& [name, help] : names_and_help) {
    std::string flag = "--" + name;
    std::ranges::replace(flag, '_', '-');
    std::string set = stage;
    set.append(".").append(name).append("=");
    to->add_option_function<std::string>(
          flag, [set, &request](const std::string& value) { request.arguments.set.push_back(set + value); },
          help)
        ->type_name("VALUE");
  }
}

void CommandLine::add_parts(CLI::App* to, const std::string& stage, StudyRequest& request) {
  request.stage = stage;
  CLI::Option* shard =
      to->add_option("--shard", request.shard, "Only the i-th of n parts of the study, on any machine")
          ->type_name("i/n");
  to->add_flag("--merge", request.merge, "Do nothing anew, but merge what the parts in the folder gave")
      ->excludes(shard);
}

void CommandLine::add_bound() {
  bound_app = command("bound", "Say before a recording how well it would determine the parameters");
  add_own_pipeline(bound_app, "bound.yaml", kBoundPipeline, "out/bound", "--threads", bound);
  add_rig(bound_app, bound.arguments);
  add_stage_options(bound_app, "study.bound", bound,
                    {{"scene", kScenes},
                     {"scene_file", "A scene of your own in YAML"},
                     {"duration", "How long to record: 10s"},
                     {"motion", "How the plate turns: constant, varying, reversal, stop_and_go"},
                     {"min_rate", "Slowest rate of a varying motion: 0Hz"},
                     {"max_rate", "Fastest rate, or the only one: 2Hz"},
                     {"noise", "Standard deviation of a range: 12mm"},
                     {"beams", "all, or in_plane: of each laser the two in the plate's plane"},
                     {"calibration", "The scanner as a calibration found it, not as it nominally is"}});
}

void CommandLine::add_basin() {
  basin_app = command("basin", "Calibrate from starts all over the range, and see where each ends");
  basin_app->add_option("-n,--starts", basin_starts, "How many")
      ->check(whole_number(1, 1000000))
      ->capture_default_str();
  add_own_pipeline(basin_app, "basin.yaml", kBasinPipeline, "out/basin", "-j,--threads", basin.run);
  add_rig(basin_app, basin.run.arguments);
  add_parts(basin_app, "study.basin", basin);
  add_stage_options(basin_app, "study.basin", basin.run,
                    {{"scene", kScenes},
                     {"scene_file", "A scene of your own in YAML"},
                     {"beams", "in_plane: of each laser the two in the plate's plane; or all"}});
}

void CommandLine::add_record() {
  record_app = command("record", "Record what the devices of a rig send, until Ctrl-C");
  add_own_pipeline(record_app, "record.yaml", kRecordPipeline, "out", "--threads", record);
  add_rig(record_app, record.arguments);
  add_stage_options(
      record_app, "grabber.live", record,
      {{"duration", "How long from the first item on, instead of until Ctrl-C"},
       {"listen", "Address of this machine for the plate's datagrams: 127.0.0.1, or 0.0.0.0 for all"}});
  add_stage_options(record_app, "write.capture", record,
                    {{"file", "The capture, instead of hub.pcap in the folder"},
                     {"most_bytes", "Begin a new file after about so many"},
                     {"most_seconds", "Begin a new file after so long: 600s"}});
}

void CommandLine::add_emulate() {
  emulate_app =
      command("emulate", "Be a simulated scanner's lasers and plate, at 127.0.0.1 or the rig's addresses");
  add_own_pipeline(emulate_app, "emulate.yaml", kEmulatePipeline, "out/emulate", "--threads", emulate);
  add_rig(emulate_app, emulate.arguments);
  add_stage_options(emulate_app, "grabber.simulate", emulate,
                    {{"duration", "How long: 60s"},
                     {"scene", kScenes},
                     {"motion", "How the plate turns: constant, varying, reversal, stop_and_go"}});
  add_stage_options(emulate_app, "emulate.rig", emulate,
                    {{"speed", "Times real time; 0: as fast as the clients take it"},
                     {"plate_to", "Where the plate's datagrams are sent: 127.0.0.1:4000"}});
}

void CommandLine::add_report() {
  report_app = command("report", "Write one HTML page of what a run or a batch left in a folder");
  report.file = "report.yaml";
  report.text = kReportPipeline;
  report_app
      ->add_option("folder", report.arguments.input, "The folder that crisp run or crisp batch wrote into")
      ->required()
      ->type_name("FOLDER");
  add_rig(report_app, report.arguments);
  add_stage_options(report_app, "report.folder", report,
                    {{"file", "The page, instead of report.html in the folder"},
                     {"points", "Most points that the page's cloud has"},
                     {"against", "An earlier calibration of the scanner, to be shown beside"}});
  add_run_options(report_app, "--threads", report);
}

void CommandLine::add_convert() {
  convert_app = command("convert", "Write a PCD file's cloud, or each of a folder, as LAS, PLY or PCD");
  convert_app->add_option("input", convert.from, "The cloud, or a folder of them")
      ->required()
      ->type_name("PATH");
  convert_app
      ->add_option(
          "output", convert.to,
          "The new file, whose ending says what it is: .las, .ply or .pcd; with --format, its folder")
      ->required()
      ->type_name("PATH");
  convert_app->add_option("--format", convert.format, "What to make of each cloud")
      ->check(CLI::IsMember({"las", "ply", "pcd"}));
  convert.run.file = "convert.yaml";
  add_set(convert_app, convert.run.arguments);
  add_run_options(convert_app, "--threads", convert.run);
  add_stage_options(convert_app, "grabber.cloud", convert.run,
                    {{"shift", "What to subtract from all coordinates: [691600, 5334700, 500]"}});
}

void CommandLine::add_figures() {
  figures_app = command("figures", "Compute the paper's figures 4 to 7 as data to be plotted");
  add_own_pipeline(figures_app, "figures.yaml", kFiguresPipeline, "out/figures", "--threads", figures);
}

void CommandLine::add_monte_carlo() {
  monte_carlo_app =
      command("monte-carlo", "Calibrate many simulated recordings: the paper's Table 1, made anew");
  CLI::Option* runs = monte_carlo_app->add_option("-n,--runs", monte_carlo_runs,
                                                  "How many; run k has the seed --seed + k - 1");
  runs->check(whole_number(1, 1000000))->capture_default_str();
  add_own_pipeline(monte_carlo_app, "monte_carlo.yaml", kMonteCarloPipeline, "out/monte_carlo",
                   "-j,--threads", monte_carlo.run);
  add_rig(monte_carlo_app, monte_carlo.run.arguments);
  add_parts(monte_carlo_app, "study.monte_carlo", monte_carlo);
  add_stage_options(
      monte_carlo_app, "study.monte_carlo", monte_carlo.run,
      {{"scene", kScenes},
       {"scene_file", "A scene of your own in YAML"},
       {"beams", "in_plane: of each laser the two in the plate's plane; or all"},
       {"estimators", "both; or refined: the refinement alone, from where RQE would end"},
       {"outliers", "Share of the ranges that are replaced at random: 5%"},
       {"effects", "What befalls the lasers, untold to the estimators: {noise.mixed_pixels: {…}}"}});
  monte_carlo_app->add_option("--only", monte_carlo_only, "Repeat the run of this seed alone")
      ->check(whole_number(0, std::numeric_limits<std::uint64_t>::max()))
      ->excludes(runs)
      ->excludes(monte_carlo_app->get_option("--shard"))
      ->excludes(monte_carlo_app->get_option("--merge"))
      ->excludes(monte_carlo_app->get_option("--seed"));
}

void CommandLine::add_validate() {
  validate_app =
      command("validate", "Check a pipeline without running it, or a rig; exit status 2 on any mistake");
  add_pipeline(validate_app, validate_file, "The pipeline's YAML file or its name, or the rig's file")
      ->required()
      ->type_name("FILE");
  add_arguments(validate_app, validate);
}

void CommandLine::add_effects() {
  effects_app = command("effects", "List the effects that a scanner can have, or tell all of one");
  CLI::Option* name = effects_app->add_option("name", effects.name, "An effect")->type_name("EFFECT");
  effects_app->add_flag("--names", effects.names, "Names only")->excludes(name);
  effects_app->add_flag("--markdown", effects.markdown, "All of them as a page of the docs")->excludes(name);
}

void CommandLine::add_stages() {
  stages_app = command("stages", "List the stages, or those of a family, or tell all of one");
  stages_app->add_option("name", stages.name, "A stage, or a family of them")->type_name("STAGE");
  stages_app->add_flag("--names", stages.names, "Names only");
  CLI::Option* markdown = stages_app->add_flag("--markdown", stages.markdown, "As Markdown");
  stages_app->add_flag("--json-schema", stages.json_schema, "A JSON schema of pipeline files, for editors");
  stages_app->add_option("--output", stages.output, "Write the pages of the reference into this folder")
      ->type_name("FOLDER")
      ->needs(markdown);
}

void CommandLine::add_info() {
  info_app =
      command("info", "Say what files, or folders of them, hold: captures, clouds, calibrations, diagnoses");
  info_app->add_option("file", info.paths, "The files or folders")->required()->type_name("FILE");
  info_app->add_option("--rig", info.rig, "The rig whose devices are to be named")->type_name("FILE");
  CLI::Option* json = info_app->add_flag("--json", info.json, "For programs");
  info_app->add_flag("--urdf", info.urdf, "A calibration as URDF for ROS; give the --rig that has the mounts")
      ->excludes(json);
}

}  // namespace crisp
