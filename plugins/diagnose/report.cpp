// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/diagnose/report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <sstream>

namespace crisp {
namespace {

/// The candidate's parameters as they were estimated, or as far as they were.
std::vector<Parameter> parameters_of(const Departure& departure, const Calibration& calibration) {
  const Candidate& candidate = departure.candidate;
  const TermParameters* found = find_term(terms_of(calibration, candidate.owner), candidate.term.term);
  return found ? found->parameters : candidate.term.parameters;
}

std::string name_of(std::size_t owner, const Calibration& calibration) {
  return owner < calibration.lasers.size() ? calibration.lasers[owner].name : "plate";
}

/// What a recording needs to tell a candidate, "laser2.mirror.cone", from what resembles it.
std::string told_by(const std::string& candidate, const TermRegistry& terms) {
  for (const std::string& name : terms.names()) {
    if (candidate == name || candidate.ends_with("." + name)) return terms.get(name)->info().told_by;
  }
  return {};
}

/// Of a finding and of what it is confounded with.
std::vector<std::string> told_apart_by(const Finding& finding, const TermRegistry& terms) {
  std::vector<std::string> needs;
  if (finding.confounded_with.empty()) return needs;
  std::vector<std::string> names = finding.confounded_with;
  names.insert(names.begin(), finding.cause);
  for (const std::string& name : names) {
    std::istringstream all(told_by(name, terms));
    for (std::string need; std::getline(all >> std::ws, need, ';');) {
      if (std::ranges::find(needs, need) == needs.end()) needs.push_back(need);
    }
  }
  return needs;
}

/// Of the squares of the residuals beyond noise, before anything was found, those that one departure takes
/// which the others leave. In what all of them take is all that is beyond noise, at least.
double explained_by(const Departure& departure, const Diagnosis& diagnosis, double noise) {
  double all = 0;
  for (const Departure& other : diagnosis.departures) all += other.square(noise);
  const double whole = std::max(all, diagnosis.left_before.excess);
  return whole > 0 ? departure.square(noise) / whole : 0;
}

/// That noise makes as much, corrected for the number of looks. Blocks say nothing of a fine shape; the
/// profile over its covariate does, of the model that came.
double p_value_of(const Departure& departure, const Diagnosis& diagnosis) {
  if (!departure.candidate.is_fine)
    return std::min(1.0, departure.look.p_value * static_cast<double>(diagnosis.looks));
  const auto profile = std::ranges::find_if(diagnosis.left_before.profiles, [&](const Profile& one) {
    return one.laser == departure.candidate.owner && one.covariate == departure.candidate.covariate;
  });
  return profile != diagnosis.left_before.profiles.end() ? profile->p_value : 1;
}

Finding finding_of(const Departure& departure, const Calibration& calibration, const Diagnosis& diagnosis,
                   const TermRegistry& terms, double odds, double noise) {
  Finding finding{.cause = departure.candidate.term.term,
                  .scope = name_of(departure.candidate.owner, calibration),
                  .parameters = parameters_of(departure, calibration),
                  .explained_fraction = explained_by(departure, diagnosis, noise),
                  .p_value = p_value_of(departure, diagnosis),
                  .confounded_with = {},
                  .told_apart_by = {},
                  .gain = departure.gains,
                  .accepted = departure.accepted,
                  .refused = departure.refused};
  const double behind = departure.rivals.empty() ? departure.look.bic : departure.rivals.front().behind;
  finding.log10_odds = behind / 2 / std::numbers::ln10;
  for (const auto& rival : departure.rivals) {
    if (rival.behind < odds) finding.confounded_with.push_back(rival.name);
    finding.alternatives.push_back({.cause = rival.term,
                                    .scope = name_of(rival.owner, calibration),
                                    .log10_odds = rival.behind / 2 / std::numbers::ln10});
  }
  finding.told_apart_by = told_apart_by(finding, terms);
  return finding;
}

UnnamedFinding unnamed_of(const Departure& departure, const Calibration& calibration,
                          const Diagnosis& diagnosis, double noise) {
  const std::string& term = departure.candidate.term.term;  // "empirical.range_by_mirror_angle"
  const auto dot = term.find('.') + 1;
  std::string quantity = term.substr(dot, term.find("_by_") - dot);
  std::ranges::replace(quantity, '_', ' ');
  return {.covariate = departure.candidate.covariate,
          .quantity = quantity,
          .scope = name_of(departure.candidate.owner, calibration),
          .amplitude = departure.look.visible * noise,
          .unit = "m",
          .p_value = p_value_of(departure, diagnosis),
          .gain = departure.gains,
          .accepted = departure.accepted};
}

std::string reason_of(const Limit& limit, const std::string& told_by) {
  const std::string needs = told_by.empty() ? "" : "; what tells it: " + told_by;
  if (!std::isfinite(limit.size)) return "the other parameters do all that it could do to these data" + needs;
  return fmt::format(
      "beside the other parameters it would not show if it changed ranges by less than {:.0f} mm (RMS){}",
      1e3 * limit.size, needs);
}

/// What the extended model leaves over a covariate, unless something is said of that already.
void add_left_over(const SideBySide& left, const Calibration& calibration, double visible, Findings& all) {
  for (const Profile& profile : left.profiles) {
    if (!profile.departs() || profile.rms < visible) continue;
    const std::string laser = scope_of(profile, calibration);
    const bool is_known = std::ranges::any_of(all.unnamed, [&](const UnnamedFinding& known) {
      return known.covariate == profile.covariate && (known.scope == laser || known.scope == "plate");
    });
    if (is_known) continue;
    all.unnamed.push_back({.covariate = profile.covariate,
                           .quantity = "range",
                           .scope = laser,
                           .amplitude = profile.rms,
                           .unit = "m",
                           .p_value = profile.p_value,
                           .gain = {}});
  }
}

/// What departs from the simulation, before or after.
std::vector<ResidualDeparture> departures_of(const Diagnosis& diagnosis, const Calibration& calibration) {
  std::vector<ResidualDeparture> all;
  for (const Profile& before : diagnosis.left_before.profiles) {
    const auto after = std::ranges::find_if(diagnosis.left_after.profiles, [&](const Profile& other) {
      return other.laser == before.laser && other.covariate == before.covariate;
    });
    const bool is_there = after != diagnosis.left_after.profiles.end();
    if (!before.departs() && !(is_there && after->departs())) continue;
    all.push_back({.covariate = before.covariate,
                   .quantity = "range",
                   .scope = scope_of(before, calibration),
                   .amplitude = before.rms,
                   .unit = "m",
                   .p_value = before.p_value});
    if (!is_there) continue;
    all.back().amplitude_after = after->rms;
    all.back().p_value_after = after->p_value;
  }
  return all;
}

}  // namespace

std::string scope_of(const Profile& profile, const Calibration& calibration) {
  return profile.laser == kAllLasers ? "scanner" : calibration.lasers[profile.laser].name;
}

Findings findings_of(const Diagnosis& diagnosis, const Calibration& calibration, const TermRegistry& terms,
                     const SelectionSettings& settings, double noise) {
  Findings all{.findings = {},
               .unnamed = {},
               .departures = departures_of(diagnosis, calibration),
               .unobservable = {},
               .gain = diagnosis.gains,
               .before_p = diagnosis.left_before.p_value,
               .after_p = diagnosis.left_after.p_value};
  for (const Departure& departure : diagnosis.departures) {
    if (departure.candidate.is_cause()) {
      all.findings.push_back(finding_of(departure, calibration, diagnosis, terms, settings.odds, noise));
    } else {
      all.unnamed.push_back(unnamed_of(departure, calibration, diagnosis, noise));
    }
  }
  add_left_over(diagnosis.left_after, calibration, settings.visible * noise, all);
  for (const Limit& limit : diagnosis.unobservable) {
    all.unobservable.push_back({.parameter = limit.name,
                                .reason = reason_of(limit, told_by(limit.name, terms)),
                                .combination = limit.combination});
  }
  for (const std::string& cause : diagnosis.unshared) {
    all.unobservable.push_back(
        {.parameter = cause,
         .reason = terms.get(cause)->info().counts_from == CountsFrom::kRunsEpoch
                       ? "it goes by the time since a recording began: diagnose one by itself"
                       : "it goes by the plate's angle, whose zero was lost between the recordings: diagnose "
                         "one by itself",
         .combination = {}});
  }
  return all;
}

}  // namespace crisp
