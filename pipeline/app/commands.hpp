// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <crisp/pipeline.hpp>
#include <crisp/plugin_loader.hpp>
#include <crisp/registrar.hpp>

namespace crisp::app {

/// The program's exit statuses: documented in `crisp --help` and docs/reference/program.md.
enum class ExitStatus {
  done = 0,
  failed = 1,         ///< the run stopped at an error
  misused = 2,        ///< the command line, the pipeline or the rig is wrong: nothing was run
  not_trusted = 3,    ///< the run came to its end, but its result cannot be trusted
  hung_up = 129,      ///< by SIGHUP
  interrupted = 130,  ///< by SIGINT
  terminated = 143    ///< by SIGTERM
};

/// `crisp run`.
struct RunRequest {
  std::filesystem::path file;
  std::string_view text;  ///< the pipeline itself, where it comes with the program; `file` is then its name
  PipelineArguments arguments;
  unsigned threads = 1;
  std::uint64_t seed = 1;
  bool quiet = false;
  bool verbose = false;
  std::optional<std::uint16_t> metrics;  ///< port at 127.0.0.1 for a program that watches the run
};
/// Runs a pipeline; writes its summary to stdout, progress and errors to stderr.
ExitStatus run_command(const RunRequest& request, const Registrar& registrar);

/// `crisp validate`: prints every mistake of a pipeline, or of a rig, to stderr. Opens no file but the
/// pipeline's and the rig's.
ExitStatus validate_command(const std::filesystem::path& file, PipelineArguments arguments,
                            const Registrar& registrar);

/// `crisp stages`.
struct StagesRequest {
  std::string name;  ///< of a stage or a family; empty: all of them
  bool names = false;
  bool markdown = false;
  bool json_schema = false;
  std::optional<std::filesystem::path> output;  ///< a folder for the pages of the reference
};
ExitStatus stages_command(const StagesRequest& request, const Registrar& registrar);

/// `crisp effects`.
struct EffectsRequest {
  std::string name;  ///< empty: all of them
  bool names = false;
  bool markdown = false;
};
ExitStatus effects_command(const EffectsRequest& request, const Registrar& registrar);

/// `crisp plugins`: every file that was tried, and the reason of each refusal.
void list_plugins(const PluginLoader& loader);

/// `crisp info`.
struct InfoRequest {
  std::vector<std::filesystem::path> paths;
  std::optional<std::filesystem::path> rig;
  bool json = false;
  bool urdf = false;  ///< calibrations as ROS has them, in place of all else
};
/// Describes each file, and each file of a known kind in a folder. If one of several files cannot be read,
/// the listing reports its error and continues.
ExitStatus info_command(const InfoRequest& request, const Registrar& registrar);

/// An error's message and advice as lines for people, without a line break at the end.
std::string error_text(const Error& error);

/// Prints that to stderr.
void print_errors(const Error& error);

/// Prints to stderr what of a pipeline is probably not meant.
void print_warnings(const Pipeline& pipeline);

}  // namespace crisp::app
