// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/batch/effective_settings.hpp"

#include <fmt/format.h>

#include <system_error>

#include <crisp/error.hpp>

#include "pipeline/files/json_text.hpp"
#include "pipeline/files/sha256.hpp"
#include "pipeline/stage/reference.hpp"

namespace crisp::batch {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr const char* kNotThere = "not there";

Json stages_json(const Pipeline& pipeline) {
  Json stages = Json::object();
  for (const auto& node : pipeline.nodes) {
    Json fed_by = Json::array();
    for (const auto& feeders : node.feeders) {
      for (const std::size_t feeder : feeders) fed_by.push_back(pipeline.nodes[feeder].tag);
    }
    stages[node.tag] = {{"stage", node.type->name},
                        {"inputs", std::move(fed_by)},
                        {"options", stage::effective_options(node)}};
  }
  return stages;
}

/// The paths that an option names and its stage reads.
std::vector<fs::path> paths_read(const Option& option, const OptionValue& value) {
  if (option.type != OptionType::path || option.is_folder || !option.writes.empty()) return {};
  std::vector<fs::path> paths;
  const auto add = [&](const OptionScalar& scalar) {
    if (const auto* text = std::get_if<std::string>(&scalar); text && !text->empty())
      paths.emplace_back(*text);
  };
  if (const auto* one = std::get_if<OptionScalar>(&value)) add(*one);
  if (const auto* several = std::get_if<std::vector<OptionScalar>>(&value)) {
    for (const auto& scalar : *several) add(scalar);
  }
  return paths;
}

Json files_json(const LoadedPipeline& loaded) {
  Json files = Json::object();
  const auto add = [&](const fs::path& file) {
    std::error_code none;
    if (fs::is_regular_file(file, none)) files[file.string()] = files::digest_of(file).sha256;
  };
  if (!loaded.rig_file.empty()) add(loaded.rig_file);
  for (const auto& node : loaded.pipeline.nodes) {
    for (const auto& option : node.type->options) {
      for (const auto& path : paths_read(option, node.value(option))) add(path);
    }
  }
  return files;
}

void add_changes(const std::string& at, const Json& before, const Json& now,
                 std::vector<std::string>& changes) {
  if (before == now) return;
  if (!before.is_object() || !now.is_object()) {
    changes.push_back(fmt::format("{}: {} → {}", at, files::json_text(before), files::json_text(now)));
    return;
  }
  for (const auto& [key, value] : before.items()) {
    const std::string below = at.empty() ? key : fmt::format("{}.{}", at, key);
    if (now.contains(key))
      add_changes(below, value, now[key], changes);
    else
      changes.push_back(fmt::format("{}: {} any more", below, kNotThere));
  }
  for (const auto& [key, value] : now.items()) {
    if (!before.contains(key)) changes.push_back(fmt::format("{}{}{}: new", at, at.empty() ? "" : ".", key));
  }
}

}  // namespace

Json effective_settings(const LoadedPipeline& loaded, std::uint64_t seed) {
  return {{"crisp", CRISP_VERSION},
          {"seed", seed},
          {"rig", loaded.rig_file.empty() ? "default" : loaded.rig_file.string()},
          {"stages", stages_json(loaded.pipeline)},
          {"files", files_json(loaded)}};
}

std::string digest_of_settings(const Json& settings) {
  constexpr std::size_t kDigits = 16;
  return files::sha256_of(files::json_text(settings)).substr(0, kDigits);
}

std::vector<std::string> changes_of_settings(const Json& before, const Json& now) {
  constexpr std::size_t kMax = 5;
  std::vector<std::string> changes;
  add_changes({}, before, now, changes);
  for (auto& change : changes) {
    for (const std::string_view level : {"stages.", "options."}) {
      const std::size_t at = change.find(level);
      if (at != std::string::npos && at < change.find(':')) change.erase(at, level.size());
    }
  }
  if (changes.size() > kMax) {
    const std::size_t others = changes.size() - kMax;
    changes.resize(kMax);
    changes.push_back(fmt::format("and {} more", others));
  }
  return changes;
}

void check_depends_on_recording(const LoadedPipeline& one, const LoadedPipeline& other) {
  AllErrors errors;
  bool depends = false;
  for (std::size_t i = 0; i < one.pipeline.nodes.size(); ++i) {
    const PipelineNode& node = one.pipeline.nodes[i];
    for (const auto& option : node.type->options) {
      const Json value = stage::to_json(node.value(option));
      const bool differs = value != Json(stage::to_json(other.pipeline.nodes[i].value(option)));
      const bool writes = option.is_folder || !option.writes.empty();
      if (differs && !writes) depends = true;
      const bool is_path = value.is_string() && !value.get<std::string>().empty() && value != "auto";
      if (differs || !writes || !is_path) continue;
      errors.add(Error(fmt::format("{}: each recording would overwrite {} of the one before", node.tag,
                                   files::json_text(value)),
                       "begin the path with ${output}, or include ${name}", node.place_of(option.name)));
    }
  }
  if (!depends) {
    errors.add(Error("no input of the pipeline depends on the recording: every job would be the same",
                     "let it read ${input}", {.file = one.file.string()}));
  }
  errors.throw_any();
}

}  // namespace crisp::batch
