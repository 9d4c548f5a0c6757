// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <iostream>
#include <optional>
#include <utility>

#include "pipeline/app/commands.hpp"
#include "pipeline/files/folder.hpp"
#include "pipeline/files/json_text.hpp"
#include "pipeline/files/rig_file.hpp"

namespace crisp {
namespace {

namespace fs = std::filesystem;

/// A file, its kind and what it holds.
struct KnownFile {
  std::string name;
  std::string kind;
  Inspection inspection;
};

std::string head_of(const fs::path& file) {
  constexpr std::size_t kEnough = 4096;
  std::ifstream stream(file, std::ios::binary);
  std::string head(kEnough, '\0');
  stream.read(head.data(), static_cast<std::streamsize>(head.size()));
  head.resize(static_cast<std::size_t>(stream.gcount()));
  return head;
}

std::optional<KnownFile> known_by(const Inspectors& inspectors, const fs::path& file, const Rig& rig) {
  if (!fs::is_regular_file(file)) throw Error(file.string() + " is not a file");
  const std::string head = head_of(file);
  const auto knows = [&](const Inspector& inspector) { return inspector.recognises(head); };
  const auto inspector = std::ranges::find_if(inspectors, knows);
  if (inspector == inspectors.end()) return {};
  return KnownFile{file.string(), inspector->kind, inspector->inspect(file, rig)};
}

/// What a YAML file is that only other commands read, and what to do with it; nothing if it is none.
std::optional<Error> of_other_commands(const fs::path& file) {
  const std::string head = "\n" + head_of(file);
  if (head.find("\ncrisp:") == std::string::npos) return std::nullopt;
  if (head.find("\npipeline:") != std::string::npos)
    return Error(file.string() + " is a pipeline", "crisp validate checks it, crisp run runs it");
  if (head.find("\nlasers:") != std::string::npos)
    return Error(file.string() + " is a rig", "crisp validate PIPELINE --rig FILE checks it");
  return std::nullopt;
}

Error none_known(const fs::path& path, const Inspectors& inspectors) {
  if (fs::is_regular_file(path)) {
    if (fs::file_size(path) == 0) return Error(path.string() + " is empty");
    if (const auto other = of_other_commands(path)) return *other;
  }
  std::string kinds;
  for (const auto& inspector : inspectors) kinds += (kinds.empty() ? "" : ", ") + inspector.kind;
  const char* what = fs::is_directory(path) ? " holds no file of a kind that is known"
                                            : " is none of the kinds of files that are known";
  return Error(path.string() + what, "known are " + kinds);
}

/// What each file holds under its name.
nlohmann::json json_of(const std::vector<KnownFile>& files) {
  auto all = nlohmann::json::object();
  for (const auto& file : files) all[file.name] = file.inspection.data;
  return all;
}

}  // namespace

ExitStatus info_command(const fs::path& path, const std::optional<fs::path>& rig_file, bool json,
                        const Registrar& registrar) {
  try {
    if (!fs::exists(path)) throw Error("there is no file " + path.string());
    const bool is_folder = fs::is_directory(path);
    const Rig rig = rig_file ? read_rig(*rig_file) : default_rig();
    std::vector<KnownFile> files;
    for (const auto& file : is_folder ? files_in(path) : std::vector<fs::path>{path}) {
      if (auto known = known_by(registrar.inspectors(), file, rig)) files.push_back(std::move(*known));
    }
    if (files.empty()) throw none_known(path, registrar.inspectors());
    if (json) {
      std::cout << json_text(is_folder ? json_of(files) : files[0].inspection.data, 2) << "\n";
    } else {
      for (const auto& file : files) {
        std::cout << file.name << ": " << file.kind << "\n" << file.inspection.text << "\n";
      }
    }
    return ExitStatus::done;
  } catch (const Error& error) {
    print_errors(error);
  } catch (const fs::filesystem_error& error) {
    print_errors(Error(error.what(), "check its name and its rights"));
  }
  return ExitStatus::failed;
}

}  // namespace crisp
