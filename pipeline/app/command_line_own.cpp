// SPDX-License-Identifier: BSD-3-Clause
// The commands that are pipelines of their own, which come with the program.
#include <algorithm>
#include <limits>

#include "pipeline/app/command_line.hpp"
#include "pipeline/app/own_pipelines.hpp"
#include "pipeline/app/whole_number.hpp"
#include "pipeline/files/renamed_names.hpp"

namespace crisp::app {
namespace {

constexpr const char* kScenes = "Simulated scene: office, hall, street, workshop, garden, people or paper";

}  // namespace

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

void CommandLine::add_own_pipeline(CLI::App* to, const char* name, std::string_view text,
                                   const std::filesystem::path& output, const std::string& threads,
                                   RunRequest& request) {
  request.file = name;
  request.text = text;
  own_pipelines[to] = std::filesystem::path(name).stem();
  request.arguments.output = output;
  to->add_option("-o,--output", request.arguments.output, "Folder for the results [" + output.string() + "]")
      ->type_name("FOLDER");
  add_set(to, request.arguments);
  add_run_options(to, threads, request);
}

void CommandLine::add_stage_options(CLI::App* to, const std::string& stage, RunRequest& request,
                                    std::initializer_list<StageFlag> flags) {
  const auto add = [&](std::string_view name, const std::string& option, const std::string& help) {
    std::string flag = "--" + std::string(name);
    std::ranges::replace(flag, '_', '-');
    stage_options.push_back({.command = to, .flag = flag, .stage = stage, .option = option});
    const std::string set = stage + "." + option + "=";
    return to
        ->add_option_function<std::string>(
            flag, [set, &request](const std::string& value) { request.arguments.set.push_back(set + value); },
            help)
        ->type_name("VALUE");
  };
  for (const auto& [option, help, name] : flags) {
    const std::string& flag = name.empty() ? option : name;
    add(flag, option, help);
    for (const files::RenamedName& old : files::renamed_names()) {
      const bool is_old = old.kind == files::RenamedName::Kind::option && old.owner == stage &&
                          old.name == option && old.old_name != flag;
      if (is_old) add(old.old_name, std::string(old.old_name), help)->group("");  // accepted, and not listed
    }
  }
}

void CommandLine::add_parts(CLI::App* to, const std::string& stage, StudyRequest& request) {
  request.stage = stage;
  CLI::Option* shard =
      to->add_option("--shard", request.shard, "Compute only the i-th of n parts of the study")
          ->type_name("i/n");
  to->add_flag("--merge", request.merge, "Merge the results of the parts in the folder; compute nothing")
      ->excludes(shard);
}

void CommandLine::add_studies() {
  study_app = command("study", "Study the method itself: bounds, simulated recordings, the paper's figures");
  study_app->require_subcommand(1);
  add_bound();
  add_detection();
  add_basin();
  add_monte_carlo();
  add_figures();
}

void CommandLine::add_planned_recording(CLI::App* to, const std::string& stage, RunRequest& request) {
  add_stage_options(
      to, stage, request,
      {{"scene", kScenes},
       {"scene_file", "Scene file in YAML"},
       {"duration", "Duration of the recording: 10s"},
       {"motion.kind", "Motion of the plate: constant, varying, reversal, stop_and_go", "motion"},
       {"motion.min_rate", "Lowest rate of a varying motion: 0Hz", "min_rate"},
       {"motion.max_rate", "Highest rate, or the constant rate: 2Hz", "max_rate"},
       {"noise", "Standard deviation of a range: 12mm"},
       {"calibration", "Calibration of the scanner, instead of the nominal values"}});
}

void CommandLine::add_bound() {
  bound_app = command_of(*study_app, "bound",
                         "Compute the Cramer-Rao bound of the parameters for a planned recording");
  add_own_pipeline(bound_app, "bound.yaml", kBoundPipeline, "out/bound", "--threads", bound);
  add_rig(bound_app, bound.arguments);
  add_planned_recording(bound_app, "study.bound", bound);
  add_stage_options(bound_app, "study.bound", bound,
                    {{"beams", "all, or in_plane: the two beams of each laser in the plate's plane"}});
}

void CommandLine::add_detection() {
  detection_app =
      command_of(*study_app, "detection",
                 "Compute from which size on a planned recording shows each effect, and resolves its cause");
  add_own_pipeline(detection_app, "detection.yaml", kDetectionPipeline, "out/detection", "--threads",
                   detection);
  add_rig(detection_app, detection.arguments);
  add_planned_recording(detection_app, "study.detection", detection);
}

void CommandLine::add_basin() {
  basin_app = command_of(*study_app, "basin",
                         "Determine the basin of convergence: calibrate from starts all over the range");
  basin_app->add_option("-n,--starts", basin_starts, "Number of starts")
      ->check(whole_number(1, 1000000))
      ->capture_default_str();
  add_own_pipeline(basin_app, "basin.yaml", kBasinPipeline, "out/basin", "-j,--threads", basin.run);
  add_rig(basin_app, basin.run.arguments);
  add_parts(basin_app, "study.basin", basin);
  add_stage_options(basin_app, "study.basin", basin.run,
                    {{"scene", kScenes},
                     {"scene_file", "Scene file in YAML"},
                     {"beams", "in_plane: the two beams of each laser in the plate's plane; or all"}});
}

void CommandLine::add_record() {
  record_app = command("record", "Record what the devices of a rig send, until Ctrl-C");
  add_own_pipeline(record_app, "record.yaml", kRecordPipeline, "out", "--threads", record);
  add_rig(record_app, record.arguments);
  add_stage_options(record_app, "grabber.live", record,
                    {{"duration", "Duration from the first item on; default: until Ctrl-C"},
                     {"listen", "Local address for the plate's datagrams: 127.0.0.1, or 0.0.0.0 for all"}});
  add_stage_options(record_app, "write.capture", record,
                    {{"file", "Capture file, instead of hub.pcap in the folder"},
                     {"max_bytes", "Start a new file after about this many bytes"},
                     {"max_duration", "Start a new file after this duration: 600s"}});
}

void CommandLine::add_emulate() {
  emulate_app = command(
      "emulate", "Emulate a simulated scanner's lasers and plate, at 127.0.0.1 or the rig's addresses");
  add_own_pipeline(emulate_app, "emulate.yaml", kEmulatePipeline, "out/emulate", "--threads", emulate);
  add_rig(emulate_app, emulate.arguments);
  add_stage_options(
      emulate_app, "grabber.simulate", emulate,
      {{"duration", "Duration: 60s"},
       {"scene", kScenes},
       {"motion.kind", "Motion of the plate: constant, varying, reversal, stop_and_go", "motion"}});
  add_stage_options(emulate_app, "emulate.rig", emulate,
                    {{"speed", "Speed relative to real time; 0: as fast as the clients read"},
                     {"plate_to", "Destination of the plate's datagrams: 127.0.0.1:4000"}});
}

void CommandLine::add_report() {
  report_app = command("report", "Write an HTML report of a run's or a batch's results");
  report.file = "report.yaml";
  report.text = kReportPipeline;
  report_app->add_option("folder", report.arguments.input, "Output folder of crisp run or crisp batch")
      ->required()
      ->type_name("FOLDER");
  add_rig(report_app, report.arguments);
  add_stage_options(report_app, "report.folder", report,
                    {{"file", "Report file, instead of report.html in the folder"},
                     {"points", "Maximum number of points in the report's cloud"},
                     {"against", "Earlier calibration of the scanner to compare with"}});
  add_run_options(report_app, "--threads", report);
}

void CommandLine::add_convert() {
  convert_app = command("convert", "Convert a PCD cloud, or each cloud of a folder, to LAS, PLY or PCD");
  convert_app->add_option("input", convert.from, "Cloud, or folder of clouds")->required()->type_name("PATH");
  convert_app
      ->add_option("output", convert.to,
                   "Output file; its extension .las, .ply or .pcd gives the format; with --format, a folder")
      ->required()
      ->type_name("PATH");
  convert_app->add_option("--format", convert.format, "Format of each cloud")
      ->check(CLI::IsMember({"las", "ply", "pcd"}));
  convert.run.file = "convert.yaml";
  own_pipelines[convert_app] = "convert";
  add_set(convert_app, convert.run.arguments);
  add_run_options(convert_app, "--threads", convert.run);
  add_stage_options(convert_app, "grabber.cloud", convert.run,
                    {{"shift", "Offset to subtract from all coordinates: [691600, 5334700, 500]"}});
}

void CommandLine::add_figures() {
  figures_app = command_of(*study_app, "figures", "Compute the data of the paper's figures 4 to 7");
  add_own_pipeline(figures_app, "figures.yaml", kFiguresPipeline, "out/figures", "--threads", figures);
}

void CommandLine::add_monte_carlo() {
  monte_carlo_app = command_of(*study_app, "monte-carlo",
                               "Calibrate many simulated recordings: reproduces Table 1 of the paper");
  CLI::Option* runs = monte_carlo_app->add_option("-n,--runs", monte_carlo_runs,
                                                  "Number of runs; run k has the seed --seed + k - 1");
  runs->check(whole_number(1, 1000000))->capture_default_str();
  add_own_pipeline(monte_carlo_app, "monte_carlo.yaml", kMonteCarloPipeline, "out/monte_carlo",
                   "-j,--threads", monte_carlo.run);
  add_rig(monte_carlo_app, monte_carlo.run.arguments);
  add_parts(monte_carlo_app, "study.monte_carlo", monte_carlo);
  add_stage_options(
      monte_carlo_app, "study.monte_carlo", monte_carlo.run,
      {{"scene", kScenes},
       {"scene_file", "Scene file in YAML"},
       {"beams", "in_plane: the two beams of each laser in the plate's plane; or all"},
       {"estimators", "both; or refined: the refinement alone, started where RQE would end"},
       {"outliers", "Fraction of ranges replaced by random values: 5%"},
       {"effects",
        "Error effects of the simulated lasers, unknown to the estimators: {noise.mixed_pixels: {…}}"}});
  monte_carlo_app->add_option("--only", monte_carlo_only, "Repeat only the run with this seed")
      ->check(whole_number(0, std::numeric_limits<std::uint64_t>::max()))
      ->excludes(runs)
      ->excludes(monte_carlo_app->get_option("--shard"))
      ->excludes(monte_carlo_app->get_option("--merge"))
      ->excludes(monte_carlo_app->get_option("--seed"));
}

}  // namespace crisp::app
