// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/simulate/real_devices.hpp"

#include <algorithm>
#include <map>

#include <crisp/error.hpp>

#include "grabbers/simulate/built_in.hpp"
#include "pipeline/files/yaml_map.hpp"
#include "pipeline/stage/option_yaml.hpp"

namespace crisp::simulate {
namespace {

/// `crisp: 1` and `effects`, written as in the option of that name, without owners.
OptionGroups habits_of(const std::string& device) {
  const std::string file = device + ".yaml";
  const files::YamlNode root = files::parse_yaml(text_of(device_texts(), "device", device), file);
  std::vector<Error> errors;
  files::YamlMap map(root, "device", errors);
  files::check_schema(map, 1);
  OptionGroups habits;
  if (const files::YamlNode* effects = map.require("effects")) {
    const Option option{.name = "effects", .type = OptionType::groups};
    if (const auto read = stage::read_option(option, *effects, file, {}, errors))
      habits = std::get<OptionGroups>(*read);
  }
  map.refuse_others();
  if (!errors.empty()) throw Errors(std::move(errors));
  return habits;
}

bool is_in(const std::vector<EffectInfo>& catalogue, const std::string& effect) {
  return std::ranges::find(catalogue, effect, &EffectInfo::name) != catalogue.end();
}

/// Which real device each laser, or the plate, is like.
std::map<std::string, std::string> likenesses(const std::vector<std::string>& requested, const Rig& rig) {
  std::map<std::string, std::string> device_of;
  for (const std::string& wish : requested) {
    if (const auto sign = wish.find('='); sign != std::string::npos) {
      device_of[wish.substr(0, sign)] = wish.substr(sign + 1);
      continue;
    }
    for (const RigLaser& laser : rig.lasers) device_of[laser.name] = wish;
  }
  return device_of;
}

}  // namespace

const std::vector<std::string>& real_devices() {
  static const std::vector<std::string> kNames = names_of(device_texts());
  return kNames;
}

std::vector<Effect> effects_of_real_devices(const std::vector<std::string>& requested, const Rig& rig,
                                            const std::vector<EffectInfo>& catalogue) {
  OptionGroups all;
  for (const auto& [owner, device] : likenesses(requested, rig)) {
    for (OptionGroup& habit : habits_of(device)) {
      if (!is_in(catalogue, habit.name)) continue;
      habit.name = owner + "." + habit.name;
      all.push_back(std::move(habit));
    }
  }
  std::vector<Effect> effects = read_effects(all, rig, catalogue);
  for (Effect& effect : effects) effect.measured = true;
  return effects;
}

}  // namespace crisp::simulate
