// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/app/installed_pipelines.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <system_error>

#include <crisp/error.hpp>

#include "pipeline/app/own_process.hpp"
#include "pipeline/files/nearest.hpp"

namespace crisp::app {
namespace {

namespace fs = std::filesystem;

constexpr const char* kEnding = ".yaml";

}  // namespace

fs::path InstalledPipelines::find(const fs::path& file_or_name) const {
  std::error_code unknown;
  if (fs::is_regular_file(file_or_name, unknown)) return file_or_name;
  if (file_or_name.has_parent_path() || file_or_name.has_extension()) return file_or_name;
  for (const auto& folder : folders_) {
    fs::path file = folder / file_or_name;
    file += kEnding;
    if (fs::is_regular_file(file, unknown)) return file;
  }
  const auto known = names();
  throw Error(
      fmt::format("there is no file {}, and no installed pipeline of that name", file_or_name.string()),
      files::did_you_mean(file_or_name.string(), known,
                          known.empty()
                              ? "give the pipeline's YAML file"
                              : fmt::format("give a YAML file, or one of {}", fmt::join(known, ", "))));
}

std::vector<std::string> InstalledPipelines::names() const {
  std::vector<std::string> names;
  for (const auto& folder : folders_) {
    std::error_code not_there;
    for (const auto& entry : fs::directory_iterator(folder, not_there)) {
      const auto& file = entry.path();
      if (file.extension() == kEnding && file.stem() != "rig") names.push_back(file.stem());
    }
  }
  std::ranges::sort(names);
  names.erase(std::unique(names.begin(), names.end()), names.end());
  return names;
}

InstalledPipelines pipelines_of_program() {
  return InstalledPipelines::of_folder(own_file().parent_path(), CRISP_CONFIGS_FROM_BIN);
}

}  // namespace crisp::app
