// SPDX-License-Identifier: BSD-3-Clause
// The program's command line; the only file that knows CLI11.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <csignal>
#include <cstdlib>
#include <iostream>
#include <sstream>
#include <thread>

#include "pipeline/app/builtin.hpp"
#include "pipeline/app/commands.hpp"
#include "pipeline/app/completion.hpp"
#include "pipeline/app/own_pipelines.hpp"
#include "pipeline/files/nearest.hpp"

namespace crisp {
namespace {

namespace fs = std::filesystem;

constexpr const char* kFooter =
    "Exit status: 0 done; 1 a run stopped at an error; 2 the command line, the pipeline or the rig is wrong "
    "and\n"
    "nothing was run; 3 the run came to its end but its result cannot be trusted (the summary says why);\n"
    "130 or 143 interrupted. Plugins are also loaded from <libdir>/crisp/plugins, and from the files\nand "
    "folders that CRISP_PLUGINS lists.";

constexpr const char* kScenes = "What stands around: office, hall, street, workshop, garden, people or paper";

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

/// Everything that can stand on the command line, and where CLI11 puts it.
struct CommandLine {
  CLI::App app{"Turns what lasers on a spinning plate measured into one crisp cloud.", "crisp"};
  std::vector<std::string> plugins;
  RunRequest run;
  RunRequest basin;
  std::uint64_t basin_starts = 1000;
  RunRequest bound;
  RunRequest figures;
  RunRequest monte_carlo;
  RunRequest record;
  RunRequest emulate;
  std::uint64_t monte_carlo_runs = 1500;
  std::optional<std::uint64_t> monte_carlo_only;
  PipelineArguments validate;
  StagesRequest stages;
  EffectsRequest effects;
  fs::path validate_file, info_file;
  std::optional<fs::path> info_rig;
  std::string shell;
  bool info_json = false;
  CLI::App* run_app = nullptr;
  CLI::App* basin_app = nullptr;
  CLI::App* bound_app = nullptr;
  CLI::App* figures_app = nullptr;
  CLI::App* monte_carlo_app = nullptr;
  CLI::App* record_app = nullptr;
  CLI::App* emulate_app = nullptr;
  CLI::App* validate_app = nullptr;
  CLI::App* stages_app = nullptr;
  CLI::App* effects_app = nullptr;
  CLI::App* plugins_app = nullptr;
  CLI::App* info_app = nullptr;
  CLI::App* completion_app = nullptr;

  CommandLine() {
    app.set_version_flag("--version", "crisp " CRISP_VERSION);
    app.footer(kFooter);
    app.require_subcommand(1);
    add_run();
    add_record();
    add_emulate();
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

 private:
  CLI::App* command(const std::string& name, const std::string& help) {
    CLI::App* made = app.add_subcommand(name, help);
    made->add_option("--plugin", plugins, "Load this plugin, or those of this folder (may be repeated)")
        ->type_name("PATH")
        ->allow_extra_args(false);
    return made;
  }

  /// The options that decide what a pipeline's file means.
  static void add_arguments(CLI::App* to, PipelineArguments& arguments) {
    to->add_option("-i,--input", arguments.input, "What ${input} stands for")->type_name("PATH");
    to->add_option("-o,--output", arguments.output, "The folder that ${output} stands for")
        ->type_name("FOLDER");
    add_rig(to, arguments);
    add_set(to, arguments);
  }

  static void add_rig(CLI::App* to, PipelineArguments& arguments) {
    to->add_option("--rig", arguments.rig, "The rig, instead of the one that the pipeline names")
        ->type_name("FILE");
  }

  static void add_set(CLI::App* to, PipelineArguments& arguments) {
    to->add_option("--set", arguments.set,
                   "An option of a stage, tag.option=value, or a variable, name=value (may be repeated)")
        ->type_name("NAME=VALUE")
        ->allow_extra_args(false);
  }

  void add_run() {
    run_app = command("run", "Run a pipeline");
    run_app->add_option("pipeline", run.file, "The pipeline's YAML file")->required()->type_name("FILE");
    add_arguments(run_app, run.arguments);
    add_run_options(run_app, "--threads", run);
  }

  /// How a pipeline is run; the result does not depend on it, but for the seed.
  static void add_run_options(CLI::App* to, const std::string& threads, RunRequest& request) {
    request.threads = std::max(1U, std::thread::hardware_concurrency());
    to->add_option(threads, request.threads, "How many threads to use; the result does not depend on it")
        ->check(whole_number(1, 1024))
        ->capture_default_str();
    to->add_option("--seed", request.seed, "Seed of all that is drawn at random")->capture_default_str();
    to->add_option("--metrics", request.metrics,
                   "While it runs, tell how it is doing at http://127.0.0.1:PORT/metrics, for Prometheus")
        ->type_name("PORT");
    CLI::Option* quiet = to->add_flag("--quiet", request.quiet, "Print warnings and errors only");
    to->add_flag("--verbose", request.verbose, "Also print options and what flowed")->excludes(quiet);
  }

  /// A pipeline that comes with the program.
  static void add_own_pipeline(CLI::App* to, const char* name, std::string_view text, const fs::path& output,
                               const std::string& threads, RunRequest& request) {
    request.file = name;
    request.text = text;
    request.arguments.output = output;
    to->add_option("-o,--output", request.arguments.output,
                   "The folder for the results [" + output.string() + "]")
        ->type_name("FOLDER");
    add_set(to, request.arguments);
    add_run_options(to, threads, request);
  }

  /// Options of the one stage of a pipeline, as options of the command.
  static void add_stage_options(CLI::App* to, const std::string& stage, RunRequest& request,
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

  void add_bound() {
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

  void add_basin() {
    basin_app = command("basin", "Calibrate from starts all over the range, and see where each ends");
    basin_app->add_option("-n,--starts", basin_starts, "How many")
        ->check(whole_number(1, 1000000))
        ->capture_default_str();
    add_own_pipeline(basin_app, "basin.yaml", kBasinPipeline, "out/basin", "-j,--threads", basin);
    add_rig(basin_app, basin.arguments);
    add_stage_options(basin_app, "study.basin", basin,
                      {{"scene", kScenes},
                       {"scene_file", "A scene of your own in YAML"},
                       {"beams", "in_plane: of each laser the two in the plate's plane; or all"}});
  }

  void add_record() {
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

  void add_emulate() {
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

  void add_figures() {
    figures_app = command("figures", "Compute the paper's figures 4 to 7 as data to be plotted");
    add_own_pipeline(figures_app, "figures.yaml", kFiguresPipeline, "out/figures", "--threads", figures);
  }

  void add_monte_carlo() {
    monte_carlo_app =
        command("monte-carlo", "Calibrate many simulated recordings: the paper's Table 1, made anew");
    CLI::Option* runs = monte_carlo_app->add_option("-n,--runs", monte_carlo_runs,
                                                    "How many; run k has the seed --seed + k - 1");
    runs->check(whole_number(1, 1000000))->capture_default_str();
    add_own_pipeline(monte_carlo_app, "monte_carlo.yaml", kMonteCarloPipeline, "out/monte_carlo",
                     "-j,--threads", monte_carlo);
    add_rig(monte_carlo_app, monte_carlo.arguments);
    add_stage_options(
        monte_carlo_app, "study.monte_carlo", monte_carlo,
        {{"scene", kScenes},
         {"scene_file", "A scene of your own in YAML"},
         {"beams", "in_plane: of each laser the two in the plate's plane; or all"},
         {"estimators", "both; or refined: the refinement alone, from where RQE would end"},
         {"outliers", "Share of the ranges that are replaced at random: 5%"},
         {"effects", "What befalls the lasers, untold to the estimators: {noise.mixed_pixels: {…}}"}});
    monte_carlo_app->add_option("--only", monte_carlo_only, "Repeat the run of this seed alone")
        ->excludes(runs)
        ->excludes(monte_carlo_app->get_option("--seed"));
  }

  void add_validate() {
    validate_app = command("validate", "Check a pipeline without running it; exit status 2 on any mistake");
    validate_app->add_option("pipeline", validate_file, "The pipeline's YAML file")
        ->required()
        ->type_name("FILE");
    add_arguments(validate_app, validate);
  }

  void add_effects() {
    effects_app = command("effects", "List the effects that a scanner can have, or tell all of one");
    CLI::Option* name = effects_app->add_option("name", effects.name, "An effect")->type_name("EFFECT");
    effects_app->add_flag("--names", effects.names, "Names only")->excludes(name);
    effects_app->add_flag("--markdown", effects.markdown, "All of them as a page of the docs")
        ->excludes(name);
  }

  void add_stages() {
    stages_app = command("stages", "List the stages, or tell all of one");
    stages_app->add_option("name", stages.name, "A stage")->type_name("STAGE");
    stages_app->add_flag("--names", stages.names, "Names only");
    CLI::Option* markdown = stages_app->add_flag("--markdown", stages.markdown, "As Markdown");
    stages_app->add_flag("--json-schema", stages.json_schema, "A JSON schema of pipeline files, for editors");
    stages_app->add_option("--output", stages.output, "Write the pages of the reference into this folder")
        ->type_name("FOLDER")
        ->needs(markdown);
  }

  void add_info() {
    info_app = command("info", "Say what a file, or a folder of them, holds: captures, clouds, calibrations");
    info_app->add_option("file", info_file, "The file or folder")->required()->type_name("FILE");
    info_app->add_option("--rig", info_rig, "The rig whose devices are to be named")->type_name("FILE");
    info_app->add_flag("--json", info_json, "For programs");
  }
};

RunRequest basin_request(const CommandLine& line) {
  RunRequest request = line.basin;
  request.arguments.set.push_back("starts=" + std::to_string(line.basin_starts));
  return request;
}

RunRequest monte_carlo_request(const CommandLine& line) {
  RunRequest request = line.monte_carlo;
  if (line.monte_carlo_only) request.seed = *line.monte_carlo_only;
  const std::uint64_t runs = line.monte_carlo_only ? 1 : line.monte_carlo_runs;
  request.arguments.set.push_back("runs=" + std::to_string(runs));
  return request;
}

std::vector<CommandWords> completion_words(const CommandLine& line) {
  std::vector<CommandWords> commands;
  for (const CLI::App* sub : line.app.get_subcommands({})) {
    CommandWords words{sub->get_name(), {}, {}, sub == line.stages_app || sub == line.effects_app};
    for (const CLI::Option* option : sub->get_options()) {
      std::vector<std::string> names;
      for (const auto& name : option->get_lnames()) names.push_back("--" + name);
      for (const auto& name : option->get_snames()) names.push_back("-" + name);
      words.options.insert(words.options.end(), names.begin(), names.end());
      if (option->get_items_expected_max() > 0) {
        words.with_value.insert(words.with_value.end(), names.begin(), names.end());
      }
    }
    commands.push_back(std::move(words));
  }
  return commands;
}

/// Where plugins are installed: beside the program's libraries, wherever the whole was put.
fs::path plugin_folder() {
  std::error_code unknown;
  return (fs::read_symlink("/proc/self/exe", unknown).parent_path() / CRISP_PLUGINS_FROM_BIN)
      .lexically_normal();
}

/// The plugins that are installed, those of the environment, then those of the command line, of which a
/// refused one is an error.
bool load_plugins(const CommandLine& line, PluginLoader& loader) {
  if (fs::is_directory(plugin_folder())) loader.load(plugin_folder());
  if (const char* listed = std::getenv("CRISP_PLUGINS")) {
    std::istringstream paths(listed);
    for (std::string path; std::getline(paths, path, ':');) {
      if (!path.empty()) loader.load(path);
    }
  }
  const std::size_t not_asked_for = loader.tried().size();
  for (const auto& path : line.plugins) loader.load(path);
  bool all_loaded = true;
  for (std::size_t i = not_asked_for; i < loader.tried().size(); ++i) {
    const PluginRecord& plugin = loader.tried()[i];
    if (plugin.is_loaded()) continue;
    all_loaded = false;
    print_errors(Error("the plugin " + plugin.file.string() + " was refused: " + plugin.refusal));
  }
  return all_loaded;
}

ExitStatus run_program(const CommandLine& line) {
  Builtin builtin;
  Registrar& registrar = builtin.registrar();
  PluginLoader loader(registrar);
  const bool all_loaded = load_plugins(line, loader);
  if (line.plugins_app->parsed()) return plugins_command(loader);
  if (!all_loaded) return ExitStatus::misused;
  if (line.run_app->parsed()) return run_command(line.run, registrar);
  if (line.basin_app->parsed()) return run_command(basin_request(line), registrar);
  if (line.bound_app->parsed()) return run_command(line.bound, registrar);
  if (line.record_app->parsed()) return run_command(line.record, registrar);
  if (line.emulate_app->parsed()) return run_command(line.emulate, registrar);
  if (line.figures_app->parsed()) return run_command(line.figures, registrar);
  if (line.monte_carlo_app->parsed()) return run_command(monte_carlo_request(line), registrar);
  if (line.validate_app->parsed()) return validate_command(line.validate_file, line.validate, registrar);
  if (line.stages_app->parsed()) return stages_command(line.stages, registrar);
  if (line.effects_app->parsed()) return effects_command(line.effects, registrar);
  if (line.info_app->parsed()) return info_command(line.info_file, line.info_rig, line.info_json, registrar);
  std::cout << bash_completion(completion_words(line));
  return ExitStatus::done;
}

/// Whether the first word is one of the commands, if it is no option.
bool is_known_command(const CommandLine& line, int count, char** words) {
  if (count < 2 || words[1][0] == '-') return true;
  std::vector<std::string> known;
  for (const CLI::App* sub : line.app.get_subcommands({})) known.push_back(sub->get_name());
  if (std::ranges::find(known, words[1]) != known.end()) return true;
  print_errors(Error("there is no command '" + std::string(words[1]) + "'",
                     did_you_mean(words[1], known, "crisp --help lists them")));
  return false;
}

int guarded_main(int count, char** words) {
  CommandLine line;
  if (!is_known_command(line, count, words)) return static_cast<int>(ExitStatus::misused);
  try {
    line.app.parse(count, words);
  } catch (const CLI::ParseError& stop) {
    return line.app.exit(stop) == 0 ? 0 : static_cast<int>(ExitStatus::misused);
  }
  return static_cast<int>(run_program(line));
}

}  // namespace
}  // namespace crisp

namespace {

/// The program's status, unless what it said did not arrive.
int after_output(int status) {
  std::cout.flush();
  if (std::cout) return status;
  crisp::print_errors(crisp::Error("cannot write to the standard output", "make room on the disk"));
  return status == 0 ? static_cast<int>(crisp::ExitStatus::failed) : status;
}

}  // namespace

int main(int count, char** words) {
  std::signal(SIGXFSZ,
              SIG_IGN);  // a file beyond the shell's limit is an error as on a full disk, not the end
  try {
    return after_output(crisp::guarded_main(count, words));
  } catch (const crisp::Error& error) {
    crisp::print_errors(error);
  } catch (const std::exception& error) {
    std::cerr << "error: " << error.what() << "\n";
  }
  return static_cast<int>(crisp::ExitStatus::failed);
}
