// SPDX-License-Identifier: BSD-3-Clause
#include <cxxabi.h>

#include <algorithm>
#include <cstdlib>
#include <memory>
#include <set>

#include <crisp/registrar.hpp>

#include "pipeline/data/name_syntax.hpp"

namespace crisp {
namespace {

void check_options(const StageType& type) {
  std::set<std::string> seen;
  const auto object = type.make();
  for (const auto& option : type.options) {
    const auto fail = [&](const std::string& what) {
      throw Error("stage " + type.name + " declares its option '" + option.name + "' wrongly: " + what,
                  "correct the option in the stage's describe()");
    };
    if (!data::is_dotted_name(option.name)) fail("names are of a-z, 0-9 and _, with dots behind groups");
    if (!seen.insert(option.name).second) fail("it is declared twice");
    if (type.has_group(option.name)) fail("a group has the same name");
    const auto group = option.name.rfind('.');
    if (group != std::string::npos && !type.groups.contains(option.name.substr(0, group)))
      fail("its group has no help");
    if (option.help.empty()) fail("it has no help");
    if (option.type == OptionType::choice && option.choices.empty()) fail("an enumeration needs choices()");
    if (option.required) continue;
    const auto wrong = complaint(option, option.get(type.options_object(*object)));
    if (wrong) fail("its default " + *wrong + ", expected is " + expectation(option));
  }
}

void check_flow(const StageType& type) {
  const auto drives = [](const StageInput& input) { return !input.held; };
  if (!type.inputs.empty() && std::none_of(type.inputs.begin(), type.inputs.end(), drives)) {
    throw Error("stage " + type.name + " holds inputs but takes none that makes it run",
                "let describe() declare one of its inputs by takes()");
  }
  for (auto i = type.inputs.begin(); i != type.inputs.end(); ++i) {
    if (std::any_of(type.inputs.begin(), i, [&](const auto& other) { return other.kind == i->kind; })) {
      throw Error("stage " + type.name + " takes " + std::string(i->kind.name()) + " twice",
                  "let describe() declare each input once");
    }
  }
}

std::string readable(std::type_index type) {
  int failure = 0;
  const std::unique_ptr<char, decltype(&std::free)> name(
      abi::__cxa_demangle(type.name(), nullptr, nullptr, &failure), &std::free);
  return name ? name.get() : type.name();
}

}  // namespace

const Option* StageType::find_option(const std::string& option) const {
  const auto found =
      std::find_if(options.begin(), options.end(), [&](const auto& o) { return o.name == option; });
  return found == options.end() ? nullptr : &*found;
}

bool StageType::has_group(std::string_view group) const {
  return std::ranges::any_of(options, [&](const Option& option) {
    return option.name.size() > group.size() && option.name.starts_with(group) &&
           option.name[group.size()] == '.';
  });
}

bool StageType::gives(const Kind& kind) const {
  return std::find(outputs.begin(), outputs.end(), kind) != outputs.end();
}

void StageRegistry::add(StageType type) {
  if (!data::is_name_in_family(type.name)) {
    throw Error("'" + type.name + "' is not a stage's name", "write family.name, of a-z, 0-9 and _");
  }
  if (type.summary.empty())
    throw Error("stage " + type.name + " has no summary", "let describe() give one by summary()");
  check_flow(type);
  check_options(type);
  if (const auto* other = find(type.name)) {
    throw Error("there are two stages " + type.name + ": one " + other->origin + ", one " + type.origin,
                "give one of them another name, or load only one of the two");
  }
  types_.emplace(type.name, std::move(type));
}

const StageType* StageRegistry::find(const std::string& name) const {
  const auto found = types_.find(name);
  return found == types_.end() ? nullptr : &found->second;
}

std::vector<const StageType*> StageRegistry::all() const {
  std::vector<const StageType*> list;
  for (const auto& [name, type] : types_) list.push_back(&type);
  return list;
}

std::vector<std::string> StageRegistry::names() const {
  std::vector<std::string> list;
  for (const auto& [name, type] : types_) list.push_back(name);
  return list;
}

std::vector<std::string> StageRegistry::givers(const Kind& kind) const {
  std::vector<std::string> list;
  for (const auto& [name, type] : types_) {
    if (type.gives(kind)) list.push_back(name);
  }
  return list;
}

void* Registrar::other(std::type_index type) const {
  const auto found = others_.find(type);
  if (found == others_.end())
    throw Error("this program has no " + readable(type),
                "leave the plugin that needs it out, or use a newer crisp");
  return found->second.registry;
}

std::vector<std::string> Registrar::registered() const {
  std::vector<std::string> all;
  for (const auto& name : stages_.names()) all.push_back("stage " + name);
  for (const auto& [type, other] : others_) {
    if (other.kind.empty() || !other.names) continue;
    for (const auto& name : other.names()) all.push_back(other.kind + " " + name);
  }
  std::ranges::sort(all);
  return all;
}

std::function<void()> Registrar::snapshot() {
  std::vector<std::function<void()>> others;
  for (const auto& [type, other] : others_) {
    if (other.snapshot) others.push_back(other.snapshot());
  }
  return [this, stages = stages_, inspectors = inspectors_, origin = origin_, others = std::move(others)] {
    stages_ = stages;
    inspectors_ = inspectors;
    origin_ = origin;
    for (const auto& take_back : others) take_back();
  };
}

}  // namespace crisp
