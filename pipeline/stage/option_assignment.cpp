// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/stage/option_assignment.hpp"

#include <algorithm>
#include <utility>

#include "pipeline/stage/option_yaml.hpp"
#include "pipeline/stage/unknown_names.hpp"

namespace crisp::stage {

using files::YamlNode;

OptionAssignment::OptionAssignment(const StageType& type, StageSpec& spec, std::filesystem::path folder,
                                   std::vector<Error>& errors, std::vector<PipelineWarning>& warnings)
    : type_(type),
      spec_(spec),
      who_(spec.tag.empty() ? spec.stage : spec.tag),
      folder_(std::move(folder)),
      errors_(errors),
      warnings_(warnings) {}

void OptionAssignment::assign(const std::string& name, const Place& key, const YamlNode& value,
                              bool is_known) {
  if (is_of_group(name, value)) {
    for (const auto& entry : value.entries) {
      assign(name + "." + entry.key, entry.place, entry.value, is_known);
    }
    return;
  }
  const std::string current =
      accept_old_name(files::RenamedName::Kind::option, type_.name, name, key, warnings_);
  const Option* option = type_.find_option(current);
  if (!option) return refuse_name(name, key);
  spec_.places[current] = value.place;
  std::optional<OptionValue> read;
  if (is_known) read = read_option(*option, value, who_, folder_, errors_);
  if (read)
    spec_.with[current] = std::move(*read);
  else
    spec_.refused.insert(current);
}

/// Whether the value gives options of a group. An option of an earlier release can have had the group's name:
/// `motion: varying`, or a map of maps of which no key is the group's.
bool OptionAssignment::is_of_group(const std::string& name, const YamlNode& value) const {
  if (!type_.has_group(name)) return false;
  if (value.kind == YamlNode::Kind::null) return true;
  if (value.kind != YamlNode::Kind::map) return false;
  const auto is_of_this_release = [&](const files::YamlEntry& entry) {
    const std::string full = name + "." + entry.key;
    return type_.find_option(full) || type_.has_group(full);
  };
  return files::current_name(files::RenamedName::Kind::option, type_.name, name) == name ||
         std::ranges::any_of(value.entries, is_of_this_release);
}

void OptionAssignment::refuse_name(const std::string& name, const Place& key) {
  if (type_.has_group(name)) {
    errors_.emplace_back(who_ + ": '" + name + "' is a group of options, and its value is no map",
                         "write " + name + ": {OPTION: VALUE}; crisp stages " + type_.name + " lists them",
                         key);
  } else {
    errors_.emplace_back(who_ + ": there is no option '" + name + "'", no_such_option(type_, name), key);
  }
}

}  // namespace crisp::stage
