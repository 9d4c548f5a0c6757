// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "pipeline/app/batch_commands.hpp"
#include "pipeline/app/cluster_command.hpp"
#include "pipeline/app/commands.hpp"
#include "pipeline/app/convert_command.hpp"
#include "pipeline/app/study_command.hpp"

namespace crisp::app {

/// An option of a command that is one of a stage.
struct StageOption {
  const CLI::App* command;
  std::string flag;  ///< "--scene"
  std::string stage;
  std::string option;
};

/// What such an option of a command is declared by.
struct StageFlag {
  std::string option;     ///< of the stage, "motion.kind"
  std::string help;       ///< in half a sentence
  std::string name = {};  ///< of the flag, "motion"; empty: the option's
};

/// Everything that can stand on the command line, and where CLI11 puts it.
struct CommandLine {
  CLI::App app{"Self-calibration and point clouds for 2D lasers on a spinning plate.", "crisp"};
  std::vector<std::string> plugins;
  RunRequest run;
  RunRequest calibrate;
  RunRequest diagnose;
  BatchRequest batch;
  BatchStatusRequest batch_status;
  BatchTableRequest batch_table;
  BatchRetryRequest batch_retry;
  ClusterSubmitRequest cluster_submit;
  StudyRequest basin;
  std::uint64_t basin_starts = 1000;
  RunRequest bound;
  RunRequest detection;
  RunRequest figures;
  StudyRequest monte_carlo;
  RunRequest record;
  RunRequest emulate;
  RunRequest report;
  ConvertRequest convert;
  std::uint64_t monte_carlo_runs = 1500;
  std::optional<std::uint64_t> monte_carlo_only;
  PipelineArguments validate;
  StagesRequest stages;
  EffectsRequest effects;
  std::filesystem::path validate_file;
  InfoRequest info;
  std::string completion;                                ///< what to print: for bash, or settings
  std::filesystem::path completed_pipeline;              ///< the one whose settings
  std::map<const CLI::App*, std::string> own_pipelines;  ///< commands that run one of their own, and its name
  std::vector<StageOption> stage_options;
  CLI::App* run_app = nullptr;
  CLI::App* calibrate_app = nullptr;
  CLI::App* diagnose_app = nullptr;
  CLI::App* batch_app = nullptr;
  CLI::App* batch_status_app = nullptr;
  CLI::App* batch_table_app = nullptr;
  CLI::App* batch_retry_app = nullptr;
  CLI::App* cluster_app = nullptr;
  CLI::App* study_app = nullptr;
  CLI::App* basin_app = nullptr;
  CLI::App* bound_app = nullptr;
  CLI::App* detection_app = nullptr;
  CLI::App* figures_app = nullptr;
  CLI::App* monte_carlo_app = nullptr;
  CLI::App* record_app = nullptr;
  CLI::App* emulate_app = nullptr;
  CLI::App* report_app = nullptr;
  CLI::App* convert_app = nullptr;
  CLI::App* validate_app = nullptr;
  CLI::App* stages_app = nullptr;
  CLI::App* effects_app = nullptr;
  CLI::App* plugins_app = nullptr;
  CLI::App* info_app = nullptr;
  CLI::App* completion_app = nullptr;

  CommandLine();

 private:
  CLI::App* command(const std::string& name, const std::string& help);
  CLI::App* command_of(CLI::App& parent, const std::string& name, const std::string& help);
  /// The options that decide what a pipeline's file means.
  static void add_arguments(CLI::App* to, PipelineArguments& arguments);
  static void add_rig(CLI::App* to, PipelineArguments& arguments);
  static void add_set(CLI::App* to, PipelineArguments& arguments);
  /// A pipeline, by its file or by the name of an installed one.
  static CLI::Option* add_pipeline(
      CLI::App* to, std::filesystem::path& file,
      const std::string& help = "Pipeline file, or name of an installed pipeline");
  void add_run();
  /// A pipeline that comes with the program, for a recording.
  CLI::App* add_of_recording(const char* name, const std::string& help, std::string_view text,
                             RunRequest& request);
  void add_batch();
  static void add_batch_inputs(CLI::App* to, BatchRequest& request);
  /// Options of the limits of a batch's jobs.
  static void add_batch_limits(CLI::App* to, BatchRequest& request);
  void add_batch_verbs();
  void add_cluster();
  static void add_threads_and_seed(CLI::App* to, const std::string& threads, RunRequest& request);
  /// Options of running a pipeline; the result does not depend on them, but for the seed.
  static void add_run_options(CLI::App* to, const std::string& threads, RunRequest& request);
  /// A pipeline that comes with the program.
  void add_own_pipeline(CLI::App* to, const char* name, std::string_view text,
                        const std::filesystem::path& output, const std::string& threads, RunRequest& request);
  /// Options of the one stage of a pipeline, as options of the command.
  void add_stage_options(CLI::App* to, const std::string& stage, RunRequest& request,
                         std::initializer_list<StageFlag> flags);
  /// A study can be divided, and is merged then.
  static void add_parts(CLI::App* to, const std::string& stage, StudyRequest& request);
  /// Options of a study of a recording that is planned.
  void add_planned_recording(CLI::App* to, const std::string& stage, RunRequest& request);
  void add_studies();
  void add_bound();
  void add_detection();
  void add_basin();
  void add_record();
  void add_emulate();
  void add_report();
  void add_convert();
  void add_figures();
  void add_monte_carlo();
  void add_validate();
  void add_effects();
  void add_stages();
  void add_info();
  void add_completion();
};

}  // namespace crisp::app
