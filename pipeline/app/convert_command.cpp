// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/app/convert_command.hpp"

#include <algorithm>
#include <set>

#include <crisp/error.hpp>

#include "pipeline/app/own_pipelines.hpp"
#include "pipeline/files/list_files.hpp"
#include "pipeline/pcd/parts.hpp"

namespace crisp::app {
namespace {

namespace fs = std::filesystem;

/// The ending of a file's name, without its dot, in small letters.
std::string format_of(const fs::path& file) {
  for (const char* format : {"pcd", "ply", "las"}) {
    if (files::has_extension(file, {std::string(".") + format})) return format;
  }
  throw Error(file.string() + " has the extension of no known format",
              "end the name in .pcd, .ply or .las, or give --format");
}

/// The clouds of a folder, each by the name that grabber.cloud reads all of its parts by.
std::set<fs::path> clouds_in(const fs::path& folder) {
  std::set<fs::path> clouds;
  for (const auto& file : files::list_files(folder)) {
    if (!files::has_extension(file, {".pcd"}) || file.stem().extension() == ".plate") continue;
    clouds.insert(pcd::whole_of_part(file).value_or(file));
  }
  if (clouds.empty()) throw Error(folder.string() + " holds no PCD file", "name another folder, or one file");
  return clouds;
}

ExitStatus convert_one(const fs::path& from, const fs::path& to, const ConvertRequest& request,
                       const Registrar& registrar) {
  std::string text(kConvertPipeline);
  const std::string stage = "write.las";
  text.replace(text.rfind(stage), stage.size(), "write." + format_of(to));
  RunRequest run = request.run;
  run.text = text;
  run.arguments.input = from;
  run.arguments.set.push_back("to=" + to.string());
  return run_command(run, registrar);
}

}  // namespace

ExitStatus convert_command(const ConvertRequest& request, const Registrar& registrar) try {
  const bool is_folder = fs::is_directory(request.from);
  if (is_folder && request.format.empty())
    throw Error(request.from.string() + " is a folder, and no format for its clouds is given",
                "give --format las");
  if (request.format.empty()) return convert_one(request.from, request.to, request, registrar);
  const auto clouds = is_folder ? clouds_in(request.from) : std::set{request.from};
  ExitStatus worst = ExitStatus::done;
  for (const auto& cloud : clouds) {
    const fs::path to = request.to / (cloud.stem().string() + "." + request.format);
    worst = std::max(worst, convert_one(cloud, to, request, registrar));
    if (worst > ExitStatus::not_trusted) break;  // by a signal
  }
  return worst;
} catch (const Error& error) {
  print_errors(error);
  return ExitStatus::misused;
}

}  // namespace crisp::app
