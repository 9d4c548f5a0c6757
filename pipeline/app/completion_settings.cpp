// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/app/completion_settings.hpp"

#include <crisp/error.hpp>
#include <crisp/pipeline.hpp>

#include "pipeline/files/yaml.hpp"
#include "pipeline/stage/pipeline_plan.hpp"

namespace crisp::app {
namespace {

void add_settings(const StageType& type, const std::string& tag, std::vector<std::string>& settings) {
  for (const auto& option : type.options) {
    const std::string name = tag + "." + option.name + "=";
    const auto values = values_to_complete(option);
    if (values.empty()) settings.push_back(name);
    for (const auto& value : values) settings.push_back(name + value);
  }
}

std::vector<std::string> settings_of(const files::YamlNode& root, const std::filesystem::path& folder,
                                     const StageRegistry& stages) {
  std::vector<std::string> settings;
  if (const files::YamlNode* variables = root.find("vars")) {
    for (const auto& variable : variables->entries) settings.push_back(variable.key + "=");
  }
  std::vector<Error> ignored;  // crisp validate reports them
  auto plan = stage::parse_plan(root, folder, {.only_validate = true}, stages, ignored);
  name_stages(plan.stages);
  for (const auto& spec : plan.stages) {
    if (const StageType* type = stages.find(spec.stage)) add_settings(*type, spec.tag, settings);
  }
  return settings;
}

}  // namespace

std::vector<std::string> values_to_complete(const Option& option) {
  auto values = option.choices;
  if (option.type == OptionType::boolean) values = {"true", "false"};
  if (option.may_be_auto && !values.empty()) values.emplace_back("auto");
  return values;
}

std::vector<std::string> settings_to_complete(const std::filesystem::path& pipeline,
                                              const StageRegistry& stages) {
  std::vector<std::string> settings;
  try {
    if (!pipeline.empty()) settings = settings_of(files::read_yaml(pipeline), pipeline.parent_path(), stages);
  } catch (const Error&) {
    settings.clear();
  }
  if (!settings.empty()) return settings;
  for (const auto* type : stages.all()) add_settings(*type, type->name, settings);
  return settings;
}

}  // namespace crisp::app
