// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "pipeline/files/quantity.hpp"
#include "pipeline/stage/reference.hpp"

namespace crisp::stage {
namespace {

using Json = nlohmann::ordered_json;

/// A variable may stand for any value.
const Json kVariable = {{"type", "string"}, {"pattern", R"(\$\{[A-Za-z0-9_]+\})"}};

Json number_schema(const Option& option) {
  Json number = {{"type", option.type == OptionType::integer ? "integer" : "number"}};
  if (std::isfinite(option.min) && std::abs(option.min) < 9e18) number["minimum"] = option.min;
  if (std::isfinite(option.max) && std::abs(option.max) < 9e18) number["maximum"] = option.max;
  Json any = Json::array({number});
  const auto units = files::units_of(option.unit);
  if (!units.empty()) {
    any.push_back(
        {{"type", "string"},
         {"pattern", fmt::format("^[-+]?[0-9.]+([eE][-+]?[0-9]+)? *({})$", fmt::join(units, "|"))}});
  }
  any.push_back(kVariable);
  return {{"anyOf", any}};
}

Json scalar_schema(const Option& option) {
  switch (option.type) {
    case OptionType::boolean:
      return {{"anyOf", Json::array({Json{{"type", "boolean"}}, kVariable})}};
    case OptionType::integer:
    case OptionType::number:
      return number_schema(option);
    default:
      break;
  }
  if (option.choices.empty()) return {{"type", "string"}};
  return {{"anyOf", Json::array({Json{{"enum", option.choices}}, kVariable})}};
}

Json option_schema(const Option& option, const OptionValue& fallback) {
  Json schema = scalar_schema(option);
  if (option.type == OptionType::groups) {
    const Json values = {{"type", Json::array({"object", "null"})},
                         {"additionalProperties", {{"type", Json::array({"string", "number"})}}}};
    schema = {{"type", "object"}, {"additionalProperties", values}};
  }
  if (option.list) {
    Json list = {{"type", "array"}, {"items", schema}, {"minItems", option.min_count}};
    if (option.max_count != std::numeric_limits<std::size_t>::max()) list["maxItems"] = option.max_count;
    schema = {{"anyOf", Json::array({list, schema})}};
  }
  if (option.may_be_auto) schema = {{"anyOf", Json::array({Json{{"const", "auto"}}, schema})}};
  schema["description"] = option.help + " (" + expectation(option) + ")";
  if (!option.required) schema["default"] = to_json(fallback);
  return schema;
}

/// Schema of the map of a group's options, or of all options.
/// @param prefix  "links." for the group links, "" for all
Json options_schema(const StageType& type, Stage& stage, const std::string& prefix) {
  Json options = Json::object();
  std::vector<std::string> required;
  for (const auto& option : type.options) {
    if (!option.name.starts_with(prefix)) continue;
    const std::string rest = option.name.substr(prefix.size());
    const std::string name = rest.substr(0, rest.find('.'));
    if (option.required && std::ranges::find(required, name) == required.end()) required.push_back(name);
    if (name == rest)
      options[name] = option_schema(option, option.get(type.options_object(stage)));
    else if (!options.contains(name))
      options[name] = options_schema(type, stage, prefix + name + ".");
  }
  Json schema = {
      {"type", Json::array({"object", "null"})}, {"properties", options}, {"additionalProperties", false}};
  const auto help = type.groups.find(prefix.substr(0, prefix.rfind('.')));
  if (help != type.groups.end()) schema["description"] = help->second;
  if (!required.empty()) schema["required"] = required;
  return schema;
}

Json stage_schema(const StageType& type) {
  const auto stage = type.make();
  const Json with = options_schema(type, *stage, "");
  const Json text = {{"type", "string"}};
  Json schema = {{"type", "object"},
                 {"description", type.summary},
                 {"properties",
                  {{"stage", {{"const", type.name}}},
                   {"tag", text},
                   {"inputs", {{"anyOf", Json::array({text, Json{{"type", "array"}, {"items", text}}})}}},
                   {"with", with}}},
                 {"additionalProperties", false},
                 {"required", Json::array({"stage"})}};
  if (with.contains("required")) schema["required"].push_back("with");
  return schema;
}

}  // namespace

Json pipeline_schema(const StageRegistry& stages) {
  Json any = Json::array();
  for (const auto* type : stages.all()) any.push_back(stage_schema(*type));
  return {{"$schema", "https://json-schema.org/draft/2020-12/schema"},
          {"title", "a pipeline of crisp"},
          {"type", "object"},
          {"properties",
           {{"crisp", {{"const", 1}}},
            {"rig", {{"type", Json::array({"string", "object"})}}},
            {"vars", {{"type", "object"}}},
            {"pipeline", {{"type", "array"}, {"minItems", 1}, {"items", {{"anyOf", any}}}}}}},
          {"additionalProperties", false},
          {"required", Json::array({"crisp", "pipeline"})}};
}

}  // namespace crisp::stage
