// SPDX-License-Identifier: BSD-3-Clause
// The commands that are pipelines of their own, which come with the program.
#include <algorithm>
#include <limits>

#include "pipeline/app/command_line.hpp"
#include "pipeline/app/own_pipelines.hpp"
#include "pipeline/app/whole_number.hpp"

namespace crisp {
namespace {

constexpr const char* kScenes = "What stands around: office, hall, street, workshop, garden, people or paper";

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

}  // namespace crisp
