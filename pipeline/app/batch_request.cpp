// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/app/batch_request.hpp"

namespace crisp::app {
namespace {

namespace fs = std::filesystem;

void replace_all(std::string& text, const std::string& what, const std::string& by) {
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + by.size()))
    text.replace(at, what.size(), by);
}

}  // namespace

nlohmann::ordered_json arguments_json(const BatchRequest& request) {
  return {{"folder", fs::current_path().string()},
          {"pipeline", request.run.file.string()},
          {"inputs", request.inputs},
          {"each", request.each},
          {"base", request.base.string()},
          {"rig", request.rig},
          {"set", request.run.arguments.set},
          {"seed", request.run.seed}};
}

void set_arguments(const nlohmann::ordered_json& arguments, BatchRequest& request) {
  request.run.file = arguments.at("pipeline").get<std::string>();
  request.inputs = arguments.at("inputs").get<std::vector<std::string>>();
  request.each = arguments.at("each");
  request.base = arguments.at("base").get<std::string>();
  request.rig = arguments.at("rig");
  request.run.arguments.set = arguments.at("set").get<std::vector<std::string>>();
  request.run.seed = arguments.at("seed");
}

std::vector<std::string> batch_words(const BatchRequest& request) {
  const BatchRequest defaults;
  std::vector<std::string> words = {request.run.file.string()};
  const auto add = [&](const char* option, const std::string& value) {
    words.insert(words.end(), {option, value});
  };
  for (const auto& input : request.inputs) add("-i", input);
  add("-o", request.output.string());
  if (request.each != defaults.each) add("--each", request.each);
  if (!request.base.empty()) add("--base", request.base.string());
  if (!request.rig.empty()) add("--rig", request.rig);
  for (const auto& set : request.run.arguments.set) add("--set", set);
  if (!request.timeout.empty()) add("--timeout", request.timeout);
  if (request.memory > 0) add("--memory", std::to_string(request.memory));
  if (request.run.threads != defaults.run.threads) add("--threads", std::to_string(request.run.threads));
  if (request.run.seed != defaults.run.seed) add("--seed", std::to_string(request.run.seed));
  return words;
}

fs::path rig_path(const std::string& pattern, const batch::BatchInput& input) {
  const fs::path recording(input.path);
  std::string path = pattern;
  replace_all(path, "{folder}", (input.is_folder ? recording : recording.parent_path()).string());
  replace_all(path, "{stem}", (input.is_folder ? recording.filename() : recording.stem()).string());
  replace_all(path, "{name}", input.name);
  return fs::absolute(path).lexically_normal();
}

bool has_rig_each(const BatchRequest& request) { return request.rig.find('{') != std::string::npos; }

}  // namespace crisp::app
