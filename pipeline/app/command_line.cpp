// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/app/command_line.hpp"

#include <limits>

#include "pipeline/app/installed_pipelines.hpp"
#include "pipeline/app/own_pipelines.hpp"
#include "pipeline/app/own_process.hpp"
#include "pipeline/app/usage_message.hpp"
#include "pipeline/app/whole_number.hpp"

namespace crisp::app {
namespace {

constexpr const char* kFooter =
    "Exit status: 0 success; 1 a run stopped at an error; 2 the command line, the pipeline or the rig is\n"
    "invalid and nothing was run; 3 the run ended but its result is untrusted (the summary lists the\n"
    "caveats); 129, 130 or 143 interrupted. Plugins are also loaded from <libdir>/crisp/plugins, and\n"
    "from the files and folders that CRISP_PLUGINS lists.";

}  // namespace

CommandLine::CommandLine() {
  app.set_version_flag("--version", "crisp " CRISP_VERSION);
  app.footer(kFooter);
  app.require_subcommand(1);
  app.failure_message(
      [](const CLI::App* requested, const CLI::Error& error) { return usage_error(*requested, error); });
  add_run();
  calibrate_app = add_of_recording(
      "calibrate", "Estimate the lasers' poses and time offsets, and assemble the point cloud",
      kCalibratePipeline, calibrate);
  diagnose_app =
      add_of_recording("diagnose", "Identify and estimate the systematic errors that the sensor model lacks",
                       kDiagnosePipeline, diagnose);
  add_batch();
  add_cluster();
  add_record();
  add_emulate();
  add_report();
  add_convert();
  add_studies();
  add_validate();
  add_stages();
  add_effects();
  plugins_app = command("plugins", "List the plugins found, and why any were rejected");
  add_info();
  add_completion();
}

CLI::App* CommandLine::command(const std::string& name, const std::string& help) {
  return command_of(app, name, help);
}

CLI::App* CommandLine::command_of(CLI::App& parent, const std::string& name, const std::string& help) {
  CLI::App* made = parent.add_subcommand(name, help);
  made->add_option("--plugin", plugins, "Load this plugin, or all plugins of this folder (repeatable)")
      ->type_name("PATH")
      ->allow_extra_args(false);
  return made;
}

void CommandLine::add_arguments(CLI::App* to, PipelineArguments& arguments) {
  to->add_option("-i,--input", arguments.input, "Value of ${input}: the recording")->type_name("PATH");
  to->add_option("-o,--output", arguments.output, "Value of ${output}: the folder for results")
      ->type_name("FOLDER");
  add_rig(to, arguments);
  add_set(to, arguments);
}

void CommandLine::add_rig(CLI::App* to, PipelineArguments& arguments) {
  to->add_option("--rig", arguments.rig, "Rig file; overrides the one that the pipeline names")
      ->type_name("FILE");
}

void CommandLine::add_set(CLI::App* to, PipelineArguments& arguments) {
  to->add_option("--set", arguments.set,
                 "Set an option of a stage, tag.option=value, or a variable, name=value (repeatable)")
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

void CommandLine::add_run() {
  run_app = command("run", "Run a pipeline");
  add_pipeline(run_app, run.file)->required();
  add_arguments(run_app, run.arguments);
  add_run_options(run_app, "--threads", run);
}

void CommandLine::add_threads_and_seed(CLI::App* to, const std::string& threads, RunRequest& request) {
  to->add_option(threads, request.threads, "Number of threads; the result does not depend on it")
      ->check(whole_number(1, 1024))
      ->capture_default_str();
  to->add_option("--seed", request.seed, "Seed of the random number generators")
      ->check(whole_number(0, std::numeric_limits<std::uint64_t>::max()))
      ->capture_default_str();
}

void CommandLine::add_run_options(CLI::App* to, const std::string& threads, RunRequest& request) {
  request.threads = own_cores();
  add_threads_and_seed(to, threads, request);
  to->add_option("--metrics", request.metrics,
                 "Serve metrics of the running pipeline at http://127.0.0.1:PORT/metrics (Prometheus)")
      ->check(whole_number(1, 65535))
      ->type_name("PORT");
  CLI::Option* quiet = to->add_flag("--quiet", request.quiet, "Print warnings and errors only");
  to->add_flag("--verbose", request.verbose, "Also print options, data flow and zero counts")
      ->excludes(quiet);
}

void CommandLine::add_validate() {
  validate_app =
      command("validate", "Check a pipeline or a rig without running it; exit status 2 on any error");
  add_pipeline(validate_app, validate_file, "Pipeline file, name of an installed pipeline, or rig file")
      ->required()
      ->type_name("FILE");
  add_arguments(validate_app, validate);
}

void CommandLine::add_effects() {
  effects_app = command("effects", "List the modelled error effects, or describe one");
  CLI::Option* name =
      effects_app->add_option("name", effects.name, "Effect to describe")->type_name("EFFECT");
  effects_app->add_flag("--names", effects.names, "Names only")->excludes(name);
  effects_app->add_flag("--markdown", effects.markdown, "All effects as a page of the documentation")
      ->excludes(name);
}

void CommandLine::add_stages() {
  stages_app = command("stages", "List all stages or a family of stages, or describe one");
  stages_app->add_option("name", stages.name, "Stage to describe, or family to list")->type_name("STAGE");
  stages_app->add_flag("--names", stages.names, "Names only");
  CLI::Option* markdown = stages_app->add_flag("--markdown", stages.markdown, "As Markdown");
  stages_app->add_flag("--json-schema", stages.json_schema, "JSON schema of pipeline files, for editors");
  stages_app->add_option("--output", stages.output, "Folder for the pages of the reference")
      ->type_name("FOLDER")
      ->needs(markdown);
}

void CommandLine::add_info() {
  info_app =
      command("info", "Describe the content of files or folders: captures, clouds, calibrations, diagnoses");
  info_app->add_option("file", info.paths, "Files or folders")->required()->type_name("FILE");
  info_app->add_option("--rig", info.rig, "Rig that names the devices")->type_name("FILE");
  CLI::Option* json = info_app->add_flag("--json", info.json, "Print JSON");
  info_app->add_flag("--urdf", info.urdf, "Print a calibration as URDF for ROS; --rig gives the mounts")
      ->excludes(json);
}

void CommandLine::add_completion() {
  completion_app = command("completion", "Print a script that completes crisp's command line");
  completion_app
      ->add_option(
          "what", completion,
          "bash: the script for this shell; settings: what can stand behind --set, of a pipeline or of "
          "all stages")
      ->required()
      ->check(CLI::IsMember({"bash", "settings"}));
  add_pipeline(completion_app, completed_pipeline, "The pipeline whose settings are meant");
}

}  // namespace crisp::app
