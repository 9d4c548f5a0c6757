// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/simulate/scan_patterns.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <string>
#include <variant>

#include <crisp/error.hpp>

#include "pipeline/files/nearest.hpp"
#include "pipeline/files/quantity.hpp"

namespace crisp::simulate {
namespace {

struct Key {
  const char* name;
  const char* unit;
  double& (*value)(ScanPattern&);
};
constexpr std::array<Key, 4> kKeys = {
    {{"first_angle", "rad", [](ScanPattern& p) -> double& { return p.field.first; }},
     {"last_angle", "rad", [](ScanPattern& p) -> double& { return p.field.last; }},
     {"step", "rad", [](ScanPattern& p) -> double& { return p.field.step; }},
     {"mirror_frequency", "Hz", [](ScanPattern& p) -> double& { return p.frequency; }}}};

void read_entry(const OptionGroup& laser, const OptionGroup::Entry& entry, ScanPattern& pattern) {
  const auto* key = std::ranges::find(kKeys, entry.name, &Key::name);
  if (key == kKeys.end()) {
    std::vector<std::string> names;
    for (const Key& known : kKeys) names.emplace_back(known.name);
    throw Error(fmt::format("{} has no '{}'", laser.name, entry.name),
                files::did_you_mean(entry.name, names, fmt::format("it has {}", fmt::join(names, ", "))),
                entry.place);
  }
  const auto parsed = files::parse_quantity(entry.value, key->unit);
  if (const auto* complaint = std::get_if<files::Complaint>(&parsed)) {
    throw Error(fmt::format("{}.{}: {}", laser.name, entry.name, complaint->text),
                fmt::format("expected is a number in {}", key->unit), entry.place);
  }
  key->value(pattern) = std::get<double>(parsed);
}

ScanPattern& pattern_named(const OptionGroup& laser, const Rig& rig, std::vector<ScanPattern>& patterns) {
  const auto found = std::ranges::find(rig.lasers, laser.name, &RigLaser::name);
  if (found != rig.lasers.end()) return patterns[static_cast<std::size_t>(found - rig.lasers.begin())];
  std::vector<std::string> names;
  for (const RigLaser& known : rig.lasers) names.push_back(known.name);
  throw Error(fmt::format("the rig has no laser '{}'", laser.name),
              files::did_you_mean(laser.name, names, fmt::format("it has {}", fmt::join(names, ", "))),
              laser.place);
}

void check(const OptionGroup& laser, const ScanPattern& pattern) {
  try {
    pattern.field.beams();
  } catch (const Error& error) {
    throw Error(laser.name + ": " + error.message(), error.advice(), laser.place);
  }
  if (!(pattern.frequency > 0)) {
    throw Error(fmt::format("{}.mirror_frequency is {:g} Hz", laser.name, pattern.frequency),
                "give a frequency above 0 Hz", laser.place);
  }
}

}  // namespace

std::vector<ScanPattern> read_patterns(const OptionGroups& lasers, const Rig& rig,
                                       const ScanPattern& otherwise) {
  if (lasers.empty()) return {};
  std::vector<ScanPattern> patterns(rig.lasers.size(), otherwise);
  AllErrors errors;
  for (const OptionGroup& laser : lasers) {
    errors.keep_of([&] {
      ScanPattern& pattern = pattern_named(laser, rig, patterns);
      AllErrors of_laser;
      for (const auto& entry : laser.entries) of_laser.keep_of([&] { read_entry(laser, entry, pattern); });
      of_laser.throw_any();
      check(laser, pattern);
    });
  }
  errors.throw_any();
  return patterns;
}

}  // namespace crisp::simulate
