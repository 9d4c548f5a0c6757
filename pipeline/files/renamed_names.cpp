// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/files/renamed_names.hpp"

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <set>
#include <vector>

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
    RenamedName{Kind::option, "study.basin", "starts_a_recording", "starts_per_recording"},
    RenamedName{Kind::option, "study.basin", "tau_least", "min_tau"},
    RenamedName{Kind::option, "study.basin", "tau_most", "max_tau"},
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

/// Options of a simulated recording, which are in groups today.
struct Regrouped {
  std::string_view old_name;
  std::string_view name;
};

constexpr std::array kMotion = {
    Regrouped{"motion", "motion.kind"},         Regrouped{"min_rate", "motion.min_rate"},
    Regrouped{"max_rate", "motion.max_rate"},   Regrouped{"change_time", "motion.change_time"},
    Regrouped{"hold_time", "motion.hold_time"},
};

constexpr std::array kScanner = {
    Regrouped{"tau_off", "nominal_errors.tau"},
    Regrouped{"alpha_off", "nominal_errors.alpha"},
    Regrouped{"lambda_off", "nominal_errors.lambda"},
    Regrouped{"eta_off", "nominal_errors.eta"},
    Regrouped{"reach", "lasers.max_range"},
    Regrouped{"max_range", "lasers.max_range"},
    Regrouped{"first_angle", "lasers.first_angle"},
    Regrouped{"last_angle", "lasers.last_angle"},
    Regrouped{"step", "lasers.step"},
    Regrouped{"mirror_frequency", "lasers.mirror_frequency"},
    Regrouped{"mirror_slowest", "lasers.mirror_slowest"},
    Regrouped{"mirror_wander", "lasers.mirror_wander"},
    Regrouped{"mirror_jitter", "lasers.mirror_jitter"},
    Regrouped{"lasers", "lasers.kinds"},
};

constexpr std::array kRecording = {
    Regrouped{"plate_frequency", "encoder.frequency"},
    Regrouped{"sigma", "lasers.sigma"},
    Regrouped{"quantum", "lasers.quantum"},
    Regrouped{"language", "telegrams.language"},
    Regrouped{"remission", "telegrams.remission"},
    Regrouped{"handover", "telegrams.handover"},
    Regrouped{"handover_jitter", "telegrams.handover_jitter"},
    Regrouped{"settling_scans", "telegrams.settling_scans"},
    Regrouped{"stamp_lags", "clocks.stamp_lags"},
    Regrouped{"clock_skew", "clocks.skew"},
    Regrouped{"clock_drift", "clocks.drift"},
    Regrouped{"laser_delay", "links.laser.delay"},
    Regrouped{"laser_jitter", "links.laser.jitter"},
    Regrouped{"laser_stall_rate", "links.laser.stall_rate"},
    Regrouped{"laser_stall_time", "links.laser.stall_time"},
    Regrouped{"plate_delay", "links.plate.delay"},
    Regrouped{"plate_jitter", "links.plate.jitter"},
    Regrouped{"plate_stall_rate", "links.plate.stall_rate"},
    Regrouped{"plate_stall_time", "links.plate.stall_time"},
    Regrouped{"lost_scans", "faults.lost_scans"},
    Regrouped{"lost_readings", "faults.lost_readings"},
    Regrouped{"silences", "faults.silences"},
    Regrouped{"restarts", "faults.restarts"},
    Regrouped{"lost_frames", "faults.lost_frames"},
    Regrouped{"repeated_frames", "faults.repeated_frames"},
    Regrouped{"damaged_frames", "faults.damaged_frames"},
};

std::vector<RenamedName> all_renamed() {
  std::vector<RenamedName> all(kRenamed.begin(), kRenamed.end());
  const auto add = [&all](std::string_view owner, std::span<const Regrouped> options) {
    for (const auto& [old_name, name] : options) all.push_back({Kind::option, owner, old_name, name});
  };
  for (const char* owner : {"grabber.simulate", "study.bound", "study.detection"}) {
    add(owner, kMotion);
    add(owner, kScanner);
  }
  for (const char* owner : {"study.basin", "study.monte_carlo"}) add(owner, kMotion);
  add("grabber.simulate", kRecording);
  return all;
}

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

std::span<const RenamedName> renamed_names() {
  static const std::vector<RenamedName> all = all_renamed();
  return all;
}

std::string current_name(Kind kind, std::string_view owner, std::string_view name) {
  const auto known = renamed_names();
  const auto found = std::ranges::find_if(known, [&](const RenamedName& one) {
    return one.kind == kind && one.owner == owner && one.old_name == name;
  });
  return std::string(found == known.end() ? name : found->name);
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
