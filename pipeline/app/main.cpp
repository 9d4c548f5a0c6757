// SPDX-License-Identifier: BSD-3-Clause
#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <iostream>
#include <sstream>

#include <crisp/builtin.hpp>

#include "pipeline/app/bash_completion.hpp"
#include "pipeline/app/command_line.hpp"
#include "pipeline/app/completion_settings.hpp"
#include "pipeline/app/exhaustion.hpp"
#include "pipeline/app/own_process.hpp"
#include "pipeline/data/exception_to_error.hpp"
#include "pipeline/files/nearest.hpp"

namespace crisp::app {
namespace {

namespace fs = std::filesystem;

StudyRequest basin_request(const CommandLine& line) {
  StudyRequest request = line.basin;
  request.run.arguments.set.push_back("starts=" + std::to_string(line.basin_starts));
  return request;
}

StudyRequest monte_carlo_request(const CommandLine& line) {
  StudyRequest request = line.monte_carlo;
  if (line.monte_carlo_only) request.run.seed = *line.monte_carlo_only;
  const std::uint64_t runs = line.monte_carlo_only ? 1 : line.monte_carlo_runs;
  request.run.arguments.set.push_back("runs=" + std::to_string(runs));
  return request;
}

ClusterSubmitRequest cluster_submit_request(const CommandLine& line) {
  ClusterSubmitRequest request = line.cluster_submit;
  request.plugins = line.plugins;
  return request;
}

void add_options(const CLI::App& command, CommandWords& words) {
  for (const CLI::Option* option : command.get_options()) {
    std::vector<std::string> names;
    for (const auto& name : option->get_lnames()) names.push_back("--" + name);
    for (const auto& name : option->get_snames()) names.push_back("-" + name);
    words.options.insert(words.options.end(), names.begin(), names.end());
    if (option->get_items_expected_max() > 0)
      words.with_value.insert(words.with_value.end(), names.begin(), names.end());
  }
}

/// The pipeline of its own that the command runs, and the values of options that are those of its stage.
void add_own(const CommandLine& line, const CLI::App* command, const StageRegistry& stages,
             CommandWords& words) {
  if (const auto own = line.own_pipelines.find(command); own != line.own_pipelines.end())
    words.pipeline = own->second;
  for (const auto& given : line.stage_options) {
    if (given.command != command) continue;
    const StageType* type = stages.find(given.stage);
    const Option* option = type != nullptr ? type->find_option(given.option) : nullptr;
    if (option == nullptr) continue;
    for (const auto& value : values_to_complete(*option)) words.values.push_back(given.flag + " " + value);
  }
}

std::vector<CommandWords> completion_words(const CommandLine& line, const StageRegistry& stages) {
  std::vector<CommandWords> commands;
  for (const CLI::App* sub : line.app.get_subcommands({})) {
    CommandWords words{.name = sub->get_name(),
                       .takes_name = sub == line.stages_app || sub == line.effects_app};
    add_options(*sub, words);
    add_own(line, sub, stages, words);
    for (const CLI::App* verb : sub->get_subcommands({})) {
      words.verbs.push_back(verb->get_name());
      CommandWords with_verb{.name = words.name + " " + verb->get_name()};
      add_options(*verb, with_verb);
      add_own(line, verb, stages, with_verb);
      // It runs the batch, and takes its options.
      if (verb == line.batch_retry_app) add_options(*sub, with_verb);
      commands.push_back(std::move(with_verb));
    }
    commands.push_back(std::move(words));
  }
  return commands;
}

/// The folder of installed plugins, relative to the program.
fs::path plugin_folder() { return (own_file().parent_path() / CRISP_PLUGINS_FROM_BIN).lexically_normal(); }

/// Why a requested plugin is not in use; empty if it is. Two requested files of the same plugin have equal
/// priority.
std::string trouble_with(const PluginRecord& plugin) {
  if (plugin.skipped.empty() || fs::equivalent(plugin.skipped, plugin.file)) return plugin.refusal;
  return "it is the plugin '" + plugin.name + "' once more, of which there is " + plugin.skipped +
         "; load only one of the two, or name them differently in CRISP_PLUGIN";
}

/// A plugin runs with all rights of the user: whoever may change its file has these, too.
void print_warnings(const PluginLoader& loader) {
  for (const auto& plugin : loader.tried()) {
    if (plugin.warning.empty()) continue;
    std::cerr
        << "warning: the plugin " << plugin.file.string() << ": " << plugin.warning
        << ", and thereby run any code with your permissions; revoke the write permission of others (chmod o-w)\n";
  }
}

/// The plugins that are installed, those of the environment, then those of the command line, of which a
/// refused one is an error.
bool load_plugins(const CommandLine& line, PluginLoader& loader) {
  for (const auto& path : line.plugins) loader.prefer(path);
  if (fs::is_directory(plugin_folder())) loader.load(plugin_folder());
  if (const char* listed = std::getenv("CRISP_PLUGINS")) {
    std::istringstream paths(listed);
    for (std::string path; std::getline(paths, path, ':');) {
      if (!path.empty()) loader.load(path);
    }
  }
  const std::size_t not_requested = loader.tried().size();
  bool all_loaded = true;
  for (const auto& path : line.plugins) {
    const std::size_t before = loader.tried().size();
    loader.load(path);
    if (loader.tried().size() > before) continue;
    all_loaded = false;
    print_errors(Error("the folder " + path + " holds no plugin", "plugins are files NAME.so"));
  }
  for (std::size_t i = not_requested; i < loader.tried().size(); ++i) {
    const PluginRecord& plugin = loader.tried()[i];
    const std::string trouble = trouble_with(plugin);
    if (trouble.empty()) continue;
    all_loaded = false;
    print_errors(Error("the plugin " + plugin.file.string() + " was refused: " + trouble,
                       "correct the plugin, or leave it out"));
  }
  return all_loaded;
}

/// Missing required arguments of a batch; empty if there are none.
std::string missing_of(const BatchRequest& batch) {
  if (batch.run.file.empty()) return "pipeline";
  if (batch.inputs.empty()) return "-i";
  return batch.output.empty() ? "-o" : "";
}

ExitStatus run_batch_command(const CommandLine& line, const Registrar& registrar) {
  if (line.batch_status_app->parsed()) return batch_status_command(line.batch_status);
  if (line.batch_table_app->parsed()) return batch_table_command(line.batch_table, registrar);
  if (line.batch_retry_app->parsed()) return batch_retry_command(line.batch_retry, line.batch, registrar);
  if (const auto missing = missing_of(line.batch); !missing.empty()) {
    print_errors(Error("crisp batch: " + missing + " is missing",
                       "crisp batch PIPELINE -i RECORDINGS -o FOLDER, or status, table or retry"));
    return ExitStatus::misused;
  }
  return batch_command(line.batch, registrar);
}

ExitStatus completion_command(const CommandLine& line, const StageRegistry& stages) {
  if (line.completion == "bash") {
    std::cout << bash_completion(completion_words(line, stages));
  } else {
    for (const auto& setting : settings_to_complete(line.completed_pipeline, stages))
      std::cout << setting << '\n';
  }
  return ExitStatus::done;
}

ExitStatus run_program(const CommandLine& line) {
  Builtin builtin;
  Registrar& registrar = builtin.registrar();
  PluginLoader loader(registrar);
  const bool all_loaded = load_plugins(line, loader);
  if (line.plugins_app->parsed()) list_plugins(loader);
  print_warnings(loader);
  if (!all_loaded) return ExitStatus::misused;
  if (line.plugins_app->parsed()) return ExitStatus::done;
  if (line.run_app->parsed()) return run_command(line.run, registrar);
  if (line.calibrate_app->parsed()) return run_command(line.calibrate, registrar);
  if (line.diagnose_app->parsed()) return run_command(line.diagnose, registrar);
  if (line.batch_app->parsed()) return run_batch_command(line, registrar);
  if (line.cluster_app->parsed()) return cluster_submit_command(cluster_submit_request(line), registrar);
  if (line.basin_app->parsed()) return study_command(basin_request(line), registrar);
  if (line.bound_app->parsed()) return run_command(line.bound, registrar);
  if (line.detection_app->parsed()) return run_command(line.detection, registrar);
  if (line.record_app->parsed()) return run_command(line.record, registrar);
  if (line.emulate_app->parsed()) return run_command(line.emulate, registrar);
  if (line.report_app->parsed()) return run_command(line.report, registrar);
  if (line.convert_app->parsed()) return convert_command(line.convert, registrar);
  if (line.figures_app->parsed()) return run_command(line.figures, registrar);
  if (line.monte_carlo_app->parsed()) return study_command(monte_carlo_request(line), registrar);
  if (line.validate_app->parsed()) return validate_command(line.validate_file, line.validate, registrar);
  if (line.stages_app->parsed()) return stages_command(line.stages, registrar);
  if (line.effects_app->parsed()) return effects_command(line.effects, registrar);
  if (line.info_app->parsed()) return info_command(line.info, registrar);
  return completion_command(line, registrar.stages());
}

std::vector<std::string> names_of(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* sub : app.get_subcommands({})) names.push_back(sub->get_name());
  return names;
}

/// Whether `word`, if it is no option, is one of the commands of `app`; prints an error otherwise.
bool is_command_of(const CLI::App& app, const std::string& word, const std::vector<std::string>& further,
                   const std::string& name) {
  auto known = names_of(app);
  if (word.starts_with("-") || std::ranges::find(known, word) != known.end()) return true;
  known.insert(known.end(), further.begin(), further.end());
  print_errors(Error("there is no command '" + name.substr(name.find(' ') + 1) + word + "'",
                     files::did_you_mean(word, known, name + "--help lists them")));
  return false;
}

/// Whether the first words name a command.
bool is_known_command(const CommandLine& line, int count, char** words) {
  if (count > 1 && !is_command_of(line.app, words[1], names_of(*line.study_app), "crisp ")) return false;
  const bool is_study = count > 2 && words[1] == line.study_app->get_name();
  return !is_study || is_command_of(*line.study_app, words[2], {}, "crisp study ");
}

/// Empty arguments, mostly by an unset variable of the shell; empty if there are none.
std::string given_empty(const CLI::App& app) {
  for (const CLI::App* sub : app.get_subcommands()) {
    for (const CLI::Option* option : sub->get_options()) {
      const auto& given = option->results();
      if (std::ranges::find(given, "") != given.end()) return option->get_name();
    }
    if (auto empty = given_empty(*sub); !empty.empty()) return empty;
  }
  return {};
}

/// The words with `study` in front of a study's name, which may stand alone as in earlier releases.
std::vector<char*> with_study(const CommandLine& line, int count, char** words) {
  static char study[] = "study";
  std::vector<char*> all(words, words + count);
  const auto studies = line.study_app->get_subcommands({});
  const auto is_first = [&](const CLI::App* one) { return count > 1 && one->get_name() == words[1]; };
  if (std::ranges::any_of(studies, is_first)) all.insert(all.begin() + 1, study);
  return all;
}

int guarded_main(int given, char** given_words) {
  CommandLine line;
  std::vector<char*> all = with_study(line, given, given_words);
  const int count = static_cast<int>(all.size());
  char** words = all.data();
  if (!is_known_command(line, count, words)) return static_cast<int>(ExitStatus::misused);
  try {
    line.app.parse(count, words);
  } catch (const CLI::ParseError& stop) {
    return line.app.exit(stop) == 0 ? 0 : static_cast<int>(ExitStatus::misused);
  }
  if (const auto option = given_empty(line.app); !option.empty()) {
    print_errors(Error(option + " is empty", "is a variable of the shell not set?"));
    return static_cast<int>(ExitStatus::misused);
  }
  return static_cast<int>(run_program(line));
}

}  // namespace
}  // namespace crisp::app

namespace {

/// Whether the other end of the standard output was closed, as `head` does when it has read enough.
bool nobody_reads() {
  pollfd output{.fd = STDOUT_FILENO, .events = POLLOUT, .revents = 0};
  return poll(&output, 1, 0) == 1 && (output.revents & (POLLERR | POLLHUP)) != 0;
}

/// The program's exit status, or an error if its output could not be written.
int after_output(int status) {
  std::cout.flush();
  if (std::cout || nobody_reads()) return status;
  crisp::app::print_errors(crisp::Error("cannot write to the standard output", "make room on the disk"));
  return status == 0 ? static_cast<int>(crisp::app::ExitStatus::failed) : status;
}

}  // namespace

int main(int count, char** words) {
  std::signal(SIGXFSZ,
              SIG_IGN);  // a file beyond the shell's limit is an error as on a full disk, not the end
  crisp::app::end_where_memory_is_exhausted();
  try {
    return after_output(crisp::app::guarded_main(count, words));
  } catch (const crisp::Error& error) {
    crisp::app::print_errors(error);
  } catch (const std::exception& error) {
    crisp::app::print_errors(crisp::data::error_of(error));
  } catch (...) {
    std::cerr << "error: a plugin threw something that is no std::exception\n";
  }
  return static_cast<int>(crisp::app::ExitStatus::failed);
}
