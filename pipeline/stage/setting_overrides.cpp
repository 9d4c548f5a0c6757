// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/stage/setting_overrides.hpp"

#include <algorithm>

#include "pipeline/files/control_characters.hpp"
#include "pipeline/files/nearest.hpp"
#include "pipeline/stage/option_yaml.hpp"
#include "pipeline/stage/unknown_names.hpp"

namespace crisp::stage {
namespace {

using files::YamlNode;

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
YamlNode parse_value(const std::string& value, const std::string& text, std::vector<Error>& errors) {
  YamlNode node;
  try {
    node = files::parse_yaml(value, {});
  } catch (const Error& error) {
    errors.emplace_back(error.message(), error.advice(), place_of(text));
  }
  comes_from_command_line(node, place_of(text));
  return node;
}

/// Suggestion for a name that is neither a variable nor a tag: an option without its stage,
/// or the nearest tag.
std::string meant(const std::string& name, const std::vector<StageSpec>& specs, const StageRegistry& stages) {
  std::vector<std::string> tags;
  for (const auto& spec : specs) {
    tags.push_back(spec.tag);
    const StageType* type = stages.find(spec.stage);
    if (type && type->find_option(name)) return "did you mean '" + spec.tag + "." + name + "'?";
  }
  return files::did_you_mean(name, tags, {});
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
    value = parse_value(setting.value, setting.text, errors);  // the last one holds
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
  const auto current = [&](files::RenamedName::Kind kind, std::string_view owner, const std::string& given) {
    return accept_old_name(kind, owner, given, place, warnings);
  };
  const auto dot = setting.target.rfind('.');
  const std::string tag = current(files::RenamedName::Kind::stage, "", setting.target.substr(0, dot));
  const auto spec = std::find_if(specs.begin(), specs.end(), [&](const auto& s) { return s.tag == tag; });
  if (dot == std::string::npos || spec == specs.end()) {
    const std::string what = dot == std::string::npos ? "variable" : "stage with the tag";
    errors.emplace_back("the pipeline has no " + what + " '" + tag + "'", meant(tag, specs, stages), place);
    return;
  }
  const StageType* type = stages.find(spec->stage);
  if (!type) return;  // reported when the pipeline is built
  const std::string name =
      current(files::RenamedName::Kind::option, type->name, setting.target.substr(dot + 1));
  const Option* option = type->find_option(name);
  if (!option) {
    errors.emplace_back(tag + ": there is no option '" + name + "'", no_such_option(*type, name), place);
    return;
  }
  spec->places[name] = place;
  YamlNode node;
  if (option->list || option->type == OptionType::groups) {
    const std::size_t before = errors.size();
    node = parse_value(setting.value, setting.text, errors);
    if (errors.size() != before) {
      spec->refused.insert(name);
      return;
    }
  } else {  // taken as it is: the shell has its own quotes
    node.kind = YamlNode::Kind::scalar;
    node.text = setting.value;
    comes_from_command_line(node, place);
  }
  auto value = read_option(*option, node, tag, {}, errors);
  if (value)
    spec->with[name] = std::move(*value);
  else
    spec->refused.insert(name);
}

}  // namespace crisp::stage
