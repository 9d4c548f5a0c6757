// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/files/renamed_names.hpp"

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <set>

namespace crisp::files {
namespace {

using Kind = RenamedName::Kind;

constexpr std::array kRenamed = {
    RenamedName{Kind::stage, "", "clock.linear_program", "clock.convex_hull"},
    RenamedName{Kind::stage, "", "diagnose.rest", "diagnose.stationary"},
    RenamedName{Kind::stage, "", "diagnose.scatter", "diagnose.noise_model"},
    RenamedName{Kind::stage, "", "diagnose.stamps", "diagnose.clocks"},
    RenamedName{Kind::stage, "", "simulate.put_in", "simulate.inject"},
    RenamedName{Kind::option, "assemble.revolutions", "longest", "max_duration"},
    RenamedName{Kind::option, "calibrate.refine", "smallest", "min_cell"},
    RenamedName{Kind::option, "calibrate.refine", "largest", "max_cell"},
    RenamedName{Kind::option, "calibrate.watch", "renew", "recalibrate_parameters"},
    RenamedName{Kind::option, "clock.online", "patience", "plate_timeout"},
    RenamedName{Kind::option, "diagnose.model", "closer", "refine_beams"},
    RenamedName{Kind::option, "diagnose.noise_model", "least_gain", "min_gain"},
    RenamedName{Kind::option, "diagnose.passes", "mend", "correct"},
    RenamedName{Kind::option, "diagnose.passes", "shortest", "min_pass"},
    RenamedName{Kind::option, "diagnose.stationary", "mend", "correct"},
    RenamedName{Kind::option, "grabber.capture", "longest_wait", "max_wait"},
    RenamedName{Kind::option, "grabber.live", "longest_pause", "max_reconnect_delay"},
    RenamedName{Kind::option, "grabber.sick", "longest_pause", "max_reconnect_delay"},
    RenamedName{Kind::option, "grabber.simulate", "reach", "max_range"},
    RenamedName{Kind::option, "study.basin", "starts_a_recording", "starts_per_recording"},
    RenamedName{Kind::option, "study.basin", "tau_least", "min_tau"},
    RenamedName{Kind::option, "study.basin", "tau_most", "max_tau"},
    RenamedName{Kind::option, "study.bound", "reach", "max_range"},
    RenamedName{Kind::option, "write.capture", "most_bytes", "max_bytes"},
    RenamedName{Kind::option, "write.capture", "most_seconds", "max_duration"},
    RenamedName{Kind::key, "calibration", "doubts", "caveats"},
    RenamedName{Kind::key, "diagnosis", "artefact", "artifact"},
    RenamedName{Kind::key, "diagnosis", "artefacts", "artifacts"},
    RenamedName{Kind::key, "diagnosis", "indistinguishable", "goodness_of_fit"},
    RenamedName{Kind::key, "diagnosis", "log10_odds", "log10_bayes_factor"},
    RenamedName{Kind::key, "diagnosis", "refused", "rejection_reason"},
    RenamedName{Kind::key, "diagnosis", "told_apart_by", "resolvable_by"},
    RenamedName{Kind::key, "summary", "doubts", "caveats"},
};

void rename_in(YamlNode& node, std::string_view owner, std::set<std::string>& reported,
               const OldNameSink& warn) {
  for (auto& item : node.items) rename_in(item, owner, reported, warn);
  for (auto& entry : node.entries) {
    rename_in(entry.value, owner, reported, warn);
    const std::string name = current_name(Kind::key, owner, entry.key);
    if (name == entry.key) continue;
    if (warn && reported.insert(entry.key).second) warn(old_name_warning(entry.key, name, entry.place));
    entry.key = name;
  }
}

}  // namespace

std::span<const RenamedName> renamed_names() { return kRenamed; }

std::string current_name(Kind kind, std::string_view owner, std::string_view name) {
  const auto* const found = std::ranges::find_if(kRenamed, [&](const RenamedName& one) {
    return one.kind == kind && one.owner == owner && one.old_name == name;
  });
  return std::string(found == kRenamed.end() ? name : found->name);
}

Error old_name_warning(std::string_view old_name, std::string_view name, Place place) {
  return Error("'" + std::string(old_name) + "' is now called '" + std::string(name) + "'",
               "use the new name: the next release rejects the old one", std::move(place));
}

void rename_old_keys(YamlNode& root, std::string_view owner, const OldNameSink& warn) {
  std::set<std::string> reported;
  rename_in(root, owner, reported, warn);
}

template <class Json>
void rename_old_keys(Json& root, std::string_view owner) {
  if (root.is_array()) {
    for (auto& item : root) rename_old_keys(item, owner);
  }
  if (!root.is_object()) return;
  Json renamed = Json::object();
  for (auto& [key, value] : root.items()) {
    rename_old_keys(value, owner);
    renamed[current_name(Kind::key, owner, key)] = std::move(value);
  }
  root = std::move(renamed);
}

template void rename_old_keys(nlohmann::json&, std::string_view);
template void rename_old_keys(nlohmann::ordered_json&, std::string_view);

}  // namespace crisp::files
