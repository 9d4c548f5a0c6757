// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/stage/setting_overrides.hpp"

#include <algorithm>

#include "pipeline/files/control_characters.hpp"
#include "pipeline/files/nearest.hpp"
#include "pipeline/stage/option_assignment.hpp"
#include "pipeline/stage/unknown_names.hpp"

namespace crisp::stage {
namespace {

using files::YamlNode;
using NameOf = files::RenamedName::Kind;

/// A place that names the setting, without line and column.
Place place_of(const std::string& text) { return {"--set " + text, 0, 0}; }

void comes_from_command_line(YamlNode& node, const Place& place) {
  node.place = place;
  node.from_command_line = true;
  for (auto& item : node.items) comes_from_command_line(item, place);
  for (auto& entry : node.entries) {
    entry.place = place;
    comes_from_command_line(entry.value, place);
  }
}

/// The value as YAML, or null with an error added if it is none.
YamlNode parse_value(const std::string& value, const Place& place, std::vector<Error>& errors) {
  YamlNode node;
  try {
    node = files::parse_yaml(value, {});
  } catch (const Error& error) {
    errors.emplace_back(error.message(), error.advice(), place);
  }
  comes_from_command_line(node, place);
  return node;
}

/// Suggestion for a setting of which neither a variable nor a tag is known: an option without its stage, or
/// the nearest tag.
std::string meant(const std::string& target, const std::string& tag, const std::vector<StageSpec>& specs,
                  const StageRegistry& stages) {
  std::vector<std::string> tags;
  for (const auto& spec : specs) {
    tags.push_back(spec.tag);
    const StageType* type = stages.find(spec.stage);
    if (type && type->find_option(target)) return "did you mean '" + spec.tag + "." + target + "'?";
  }
  return files::did_you_mean(tag, tags, {});
}

/// What a setting names.
struct Target {
  StageSpec* spec = nullptr;  ///< null: no stage has such a tag
  std::string tag;            ///< as it is written; all before the last dot where no stage has it
  std::string option;         ///< behind the tag, with its groups
};

/// The stage of the longest tag with which the name begins: tags have dots, and so have options of groups.
Target find_target(const std::string& name, std::vector<StageSpec>& specs) {
  for (auto dot = name.rfind('.'); dot != std::string::npos && dot > 0; dot = name.rfind('.', dot - 1)) {
    const std::string tag = name.substr(0, dot);
    const std::string current = files::current_name(NameOf::stage, "", tag);
    const auto spec = std::ranges::find(specs, current, &StageSpec::tag);
    if (spec != specs.end()) return {&*spec, tag, name.substr(dot + 1)};
  }
  return {.spec = nullptr, .tag = name.substr(0, name.rfind('.')), .option = {}};
}

}  // namespace

Settings::Settings(const std::vector<std::string>& texts, std::vector<Error>& errors) {
  for (const auto& text : texts) {
    const auto equals = text.find('=');
    const auto control = files::find_control_character(text);
    const auto wrong = std::min(control, text.find('\n'));
    if (wrong != std::string::npos) {
      errors.emplace_back(
          "a setting is one line of text, but " + files::control_character_in_words(text[wrong]),
          "write it in one line, without that character", place_of(files::shown(text)));
    } else if (equals == std::string::npos || equals == 0) {
      errors.emplace_back("a setting needs a name and a value", "write --set tag.option=value",
                          place_of(text));
    } else {
      settings_.push_back({text, text.substr(0, equals), text.substr(equals + 1)});
    }
  }
}

std::optional<YamlNode> Settings::take_variable(const std::string& name, std::vector<Error>& errors) {
  std::optional<YamlNode> value;
  for (auto& setting : settings_) {
    if (setting.target != name) continue;
    setting.used = true;
    value = parse_value(setting.value, place_of(setting.text), errors);  // the last one holds
  }
  return value;
}

void Settings::apply(std::vector<StageSpec>& specs, const StageRegistry& stages, std::vector<Error>& errors,
                     std::vector<PipelineWarning>& warnings) {
  name_stages(specs);
  for (auto& setting : settings_) {
    if (!setting.used) apply(setting, specs, stages, errors, warnings);
  }
}

void Settings::apply(Setting& setting, std::vector<StageSpec>& specs, const StageRegistry& stages,
                     std::vector<Error>& errors, std::vector<PipelineWarning>& warnings) {
  const Place place = place_of(setting.text);
  const Target target = find_target(setting.target, specs);
  if (!target.spec) {
    const bool has_dot = setting.target.find('.') != std::string::npos;
    const std::string what = has_dot ? "stage with the tag" : "variable";
    errors.emplace_back("the pipeline has no " + what + " '" + target.tag + "'",
                        meant(setting.target, target.tag, specs, stages), place);
    return;
  }
  accept_old_name(NameOf::stage, "", target.tag, place, warnings);
  const StageType* type = stages.find(target.spec->stage);
  if (!type) return;  // reported when the pipeline is built
  const std::size_t before = errors.size();
  const YamlNode value = value_of(*type, target.option, setting.value, place, errors);
  OptionAssignment(*type, *target.spec, {}, errors, warnings)
      .assign(target.option, place, value, errors.size() == before);
}

/// A value as YAML. That of an option with one value is taken as it is: the shell has its own quotes.
YamlNode Settings::value_of(const StageType& type, const std::string& option, const std::string& value,
                            const Place& place, std::vector<Error>& errors) {
  const Option* known = type.find_option(files::current_name(NameOf::option, type.name, option));
  const bool is_structured = known && (known->list || known->type == OptionType::groups);
  if (is_structured || type.has_group(option)) return parse_value(value, place, errors);
  YamlNode node;
  node.kind = YamlNode::Kind::scalar;
  node.text = value;
  comes_from_command_line(node, place);
  return node;
}

}  // namespace crisp::stage
