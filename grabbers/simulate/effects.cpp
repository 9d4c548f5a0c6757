// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/simulate/effects.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <variant>

#include <crisp/error.hpp>

#include "pipeline/files/nearest.hpp"
#include "pipeline/files/quantity.hpp"

namespace crisp::simulate {
namespace {

class Reader {
 public:
  Reader(const Rig& rig, const std::vector<EffectInfo>& catalogue) : rig_(rig), catalogue_(catalogue) {}

  std::vector<Effect> read(const OptionGroups& requested) {
    std::vector<Effect> effects;
    for (const auto& group : requested) {
      Effect effect{.name = group.name, .owner = {}, .values = {}, .place = group.place};
      take_owner(effect);
      const EffectInfo* info = find(effect.name);
      if (!info && names_no_device(group)) continue;
      if (!info) {
        fail(group.place, fmt::format("there is no effect '{}'", group.name), suggestion(effect.name));
        continue;
      }
      check_owner(effect, *info);
      for (const auto& entry : group.entries) read_value(entry, *info, effect);
      effects.push_back(std::move(effect));
    }
    if (!errors_.empty()) throw Errors(std::move(errors_));
    return effects;
  }

 private:
  void fail(const Place& place, std::string what, std::string advice) {
    errors_.emplace_back(std::move(what), std::move(advice), place);
  }

  const EffectInfo* find(const std::string& name) const {
    const auto found = std::ranges::find(catalogue_, name, &EffectInfo::name);
    return found == catalogue_.end() ? nullptr : &*found;
  }

  std::string suggestion(const std::string& name) const {
    std::vector<std::string> names;
    for (const auto& info : catalogue_) names.push_back(info.name);
    return files::did_you_mean(name, names, "`crisp effects` lists the effects");
  }

  /// Splits the owner off a name that is no effect as a whole: effects may begin with "plate." themselves.
  void take_owner(Effect& effect) const {
    const auto dot = effect.name.find('.');
    if (find(effect.name) || dot == std::string::npos) return;
    const std::string first = effect.name.substr(0, dot);
    const auto laser = std::ranges::find(rig_.lasers, first, &RigLaser::name);
    if (laser != rig_.lasers.end()) {
      effect.owner = static_cast<std::size_t>(laser - rig_.lasers.begin());
    } else if (first == "plate" || first == rig_.plate.name) {
      effect.owner = rig_.lasers.size();
    } else {
      return;
    }
    effect.name.erase(0, dot + 1);
  }

  /// Whether an existing effect has an owner that the rig does not have.
  bool names_no_device(const OptionGroup& group) {
    const auto dot = group.name.find('.');
    if (dot == std::string::npos || !find(group.name.substr(dot + 1))) return false;
    std::vector<std::string> devices;
    for (const auto& laser : rig_.lasers) devices.push_back(laser.name);
    devices.push_back(rig_.plate.name);
    const std::string owner = group.name.substr(0, dot);
    fail(group.place, fmt::format("{}: the rig has no '{}'", group.name, owner),
         files::did_you_mean(owner, devices, fmt::format("it has {}", fmt::join(devices, ", "))));
    return true;
  }

  void check_owner(const Effect& effect, const EffectInfo& info) {
    if (!effect.owner || info.scope == Scope::kDevice) return;
    const bool plate = *effect.owner == rig_.lasers.size();
    if (info.scope == Scope::kScene) {
      fail(effect.place, info.name + " is the scene's, not a device's", "leave the owner out");
    } else if (info.scope == Scope::kPlate && !plate) {
      fail(effect.place, info.name + " is the plate's, not one laser's", "leave the owner out");
    } else if (info.scope == Scope::kLaser && plate) {
      fail(effect.place, info.name + " is each laser's, not the plate's",
           "put a laser's name in front, or none for all lasers");
    }
  }

  void read_value(const OptionGroup::Entry& entry, const EffectInfo& info, Effect& effect) {
    const auto parameter = std::ranges::find(info.parameters, entry.name, &EffectParameter::name);
    if (parameter == info.parameters.end()) {
      return fail(entry.place, fmt::format("{} has no parameter '{}'", info.name, entry.name),
                  parameters_of(info));
    }
    const std::string name = info.name + "." + entry.name;
    const auto parsed = files::parse_quantity(entry.value, parameter->unit);
    if (const auto* complaint = std::get_if<files::Complaint>(&parsed)) {
      return fail(
          entry.place, name + ": " + complaint->text,
          parameter->unit == "1" ? "expected is a number" : "expected is a number in " + parameter->unit);
    }
    const double value = std::get<double>(parsed);
    const bool bounded = parameter->lower < parameter->upper;
    if (bounded && (value < parameter->lower || value > parameter->upper)) {
      return fail(entry.place, fmt::format("{}: {} is out of range", name, entry.value),
                  fmt::format("it may be from {:g} to {:g} {}", parameter->lower, parameter->upper,
                              parameter->unit == "1" ? "" : parameter->unit));
    }
    effect.values.emplace_back(entry.name, value);
  }

  static std::string parameters_of(const EffectInfo& info) {
    std::string names;
    for (const auto& p : info.parameters) names += (names.empty() ? "it has " : ", ") + p.name;
    return names.empty() ? "it has none" : names;
  }

  const Rig& rig_;
  const std::vector<EffectInfo>& catalogue_;
  std::vector<Error> errors_;
};

}  // namespace

std::vector<Effect> read_effects(const OptionGroups& requested, const Rig& rig,
                                 const std::vector<EffectInfo>& catalogue) {
  return Reader(rig, catalogue).read(requested);
}

}  // namespace crisp::simulate
