// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/diagnose/report/findings_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <sstream>

namespace crisp::diagnose {
namespace {

constexpr const char* kScanner = "scanner";  ///< scope of what all lasers have in common

/// Estimates of the candidate's parameters, as far as they were estimated.
std::vector<Parameter> parameters_of(const Hypothesis& hypothesis, const Calibration& calibration) {
  const Candidate& candidate = hypothesis.candidate;
  const TermParameters* found = find_term(terms_of(calibration, candidate.owner), candidate.term.term);
  return found ? found->parameters : candidate.term.parameters;
}

std::string name_of(std::size_t owner, const Calibration& calibration) {
  return owner < calibration.lasers.size() ? calibration.lasers[owner].name : "plate";
}

/// Data that make a candidate ("laser2.mirror.cone") resolvable from similar causes.
std::string resolvable_by(const std::string& candidate, const TermRegistry& terms) {
  for (const std::string& name : terms.names()) {
    if (candidate == name || candidate.ends_with("." + name)) return terms.get(name)->info().resolvable_by;
  }
  return {};
}

/// Data that make a finding resolvable from its confounded causes.
std::vector<std::string> resolvable_by(const Finding& finding, const TermRegistry& terms) {
  std::vector<std::string> needs;
  if (finding.confounded_with.empty()) return needs;
  std::vector<std::string> names = finding.confounded_with;
  names.insert(names.begin(), finding.cause);
  for (const std::string& name : names) {
    std::istringstream all(resolvable_by(name, terms));
    for (std::string need; std::getline(all >> std::ws, need, ';');) {
      if (std::ranges::find(needs, need) == needs.end()) needs.push_back(need);
    }
  }
  return needs;
}

/// Share of the initial residuals' squares beyond noise that this hypothesis alone explains. The total is at
/// least the sum over all hypotheses.
double explained_by(const Hypothesis& hypothesis, const Diagnosis& diagnosis, double noise) {
  double all = 0;
  for (const Hypothesis& other : diagnosis.hypotheses) all += other.square(noise);
  const double whole = std::max(all, diagnosis.left_before.excess);
  return whole > 0 ? hypothesis.square(noise) / whole : 0;
}

/// p-value, corrected for multiple testing. For a fine shape it is that of the incoming model's profile over
/// its covariate, since the block-based test has too few blocks for it.
double p_value_of(const Hypothesis& hypothesis, const Diagnosis& diagnosis) {
  if (!hypothesis.candidate.is_fine)
    return std::min(1.0, hypothesis.test.p_value * static_cast<double>(diagnosis.tests));
  const auto profile = std::ranges::find_if(diagnosis.left_before.profiles, [&](const Profile& one) {
    return one.laser == hypothesis.candidate.owner && one.covariate == hypothesis.candidate.covariate;
  });
  return profile != diagnosis.left_before.profiles.end() ? profile->p_value : 1;
}

Finding finding_of(const Hypothesis& hypothesis, const Calibration& calibration, const Diagnosis& diagnosis,
                   const TermRegistry& terms, double odds, double noise) {
  Finding finding{.cause = hypothesis.candidate.family,
                  .scope = name_of(hypothesis.candidate.owner, calibration),
                  .parameters = parameters_of(hypothesis, calibration),
                  .explained_fraction = explained_by(hypothesis, diagnosis, noise),
                  .p_value = p_value_of(hypothesis, diagnosis),
                  .confounded_with = {},
                  .resolvable_by = {},
                  .gain = hypothesis.gains,
                  .tests = hypothesis.tests,
                  .accepted = hypothesis.accepted,
                  .rejection = hypothesis.rejected};
  const double behind =
      hypothesis.competitors.empty() ? hypothesis.test.bic : hypothesis.competitors.front().behind;
  finding.log10_bayes_factor = behind / 2 / std::numbers::ln10;
  for (const auto& competitor : hypothesis.competitors) {
    if (competitor.behind < odds) finding.confounded_with.push_back(competitor.name);
    finding.alternatives.push_back({.cause = competitor.term,
                                    .scope = name_of(competitor.owner, calibration),
                                    .log10_bayes_factor = competitor.behind / 2 / std::numbers::ln10});
  }
  if (!finding.confounded_with.empty())
    finding.resolvable_by =
        resolving(diagnosis.proposals, hypothesis.candidate.cause_name(), hypothesis.test.ranges);
  const std::vector<std::string> needs = resolvable_by(finding, terms);
  finding.resolvable_by.insert(finding.resolvable_by.end(), needs.begin(), needs.end());
  return finding;
}

/// Whether a cause of one owner explains no less than the hypothesis.
bool is_explained_by(const std::string& cause, std::size_t owner, const Hypothesis& one) {
  return std::ranges::any_of(one.competitors, [&](const Hypothesis::Competitor& competitor) {
    return competitor.behind <= 0 && competitor.term == cause && competitor.owner == owner;
  });
}

/// Whether the level of another hypothesis, of the same laser, explains no less than this one.
bool is_explained_by_level_of(const Hypothesis& other, const Hypothesis& one) {
  return one.candidate.level.empty() && !other.candidate.level.empty() &&
         is_explained_by(other.candidate.level, other.candidate.owner, one);
}

/// Whether an accepted hypothesis is the level of another one, in a family whose zero is a convention, or no
/// more than that.
bool is_level_of(const Hypothesis& one, const Hypothesis& other) {
  return one.accepted && other.accepted &&
         (one.candidate.is_level_of(other.candidate) || is_explained_by_level_of(other, one));
}

bool is_reported(const Hypothesis& one) { return one.candidate.is_cause(); }

/// The hypothesis as part of which one is reported: the first member of its family, or that whose level it
/// is.
const Hypothesis& reported_with(const Hypothesis& one, const std::vector<Hypothesis>& all) {
  const auto whole =
      std::ranges::find_if(all, [&](const Hypothesis& other) { return is_level_of(one, other); });
  const Hypothesis& member = whole == all.end() ? one : *whole;
  return *std::ranges::find_if(all, [&](const Hypothesis& other) {
    return other.accepted == member.accepted && is_reported(other) &&
           other.candidate.is_of_family(member.candidate);
  });
}

/// Whether the family of another hypothesis, of the same owner, explains no less than this one.
bool is_explained_by_family_of(const Hypothesis& other, const Hypothesis& one) {
  return one.accepted && other.accepted &&
         is_explained_by(other.candidate.family, other.candidate.owner, one);
}

/// For each hypothesis of a cause, the one as part of which it is reported. What the family of a more
/// significant cause explains as well, beyond the members that the model has of it, is no further cause.
std::map<const Hypothesis*, const Hypothesis*> reported_as(const std::vector<Hypothesis>& all) {
  std::map<const Hypothesis*, const Hypothesis*> as;
  std::vector<const Hypothesis*> heads;
  for (const Hypothesis& one : all) {
    if (!is_reported(one)) continue;
    as[&one] = &reported_with(one, all);
    if (as[&one] == &one) heads.push_back(&one);
  }
  std::ranges::stable_sort(heads, std::greater{}, [](const Hypothesis* one) { return one->test.bic; });
  std::vector<const Hypothesis*> kept;
  for (const Hypothesis* head : heads) {
    const auto whole = std::ranges::find_if(
        kept, [&](const Hypothesis* other) { return is_explained_by_family_of(*other, *head); });
    if (whole == kept.end()) {
      kept.push_back(head);
      continue;
    }
    for (auto& [one, with] : as) {
      if (with == head) with = *whole;
    }
  }
  return as;
}

/// Adds another member of the same family, what is its level, or what it explains as well, to a finding.
///
/// @param is_member  whether its parameters are the family's
void merge(Finding& finding, const Finding& other, bool is_member) {
  if (is_member)
    finding.parameters.insert(finding.parameters.end(), other.parameters.begin(), other.parameters.end());
  finding.explained_fraction = std::min(1.0, finding.explained_fraction + other.explained_fraction);
  finding.p_value = std::min(finding.p_value, other.p_value);
  finding.log10_bayes_factor = std::max(finding.log10_bayes_factor, other.log10_bayes_factor);
}

/// The causes, each with all accepted members of its family.
std::vector<Finding> causes_of(const Diagnosis& diagnosis, const Calibration& calibration,
                               const TermRegistry& terms, double odds, double noise) {
  const std::vector<Hypothesis>& all = diagnosis.hypotheses;
  const auto as = reported_as(all);
  std::vector<Finding> findings;
  std::map<const Hypothesis*, std::size_t> place;
  for (const Hypothesis& hypothesis : all) {
    if (!is_reported(hypothesis) || as.at(&hypothesis) != &hypothesis) continue;
    place.emplace(&hypothesis, findings.size());
    findings.push_back(finding_of(hypothesis, calibration, diagnosis, terms, odds, noise));
  }
  for (const auto& [one, with] : as) {
    if (with == one) continue;
    const bool is_member =
        one->candidate.is_of_family(with->candidate) || one->candidate.is_level_of(with->candidate);
    merge(findings[place.at(with)], finding_of(*one, calibration, diagnosis, terms, odds, noise), is_member);
  }
  return findings;
}

UnnamedFinding unnamed_of(const Hypothesis& hypothesis, const Calibration& calibration,
                          const Diagnosis& diagnosis, double noise) {
  const std::string& term = hypothesis.candidate.term.term;  // "empirical.range_by_mirror_angle"
  const auto dot = term.find('.') + 1;
  std::string quantity = term.substr(dot, term.find("_by_") - dot);
  std::ranges::replace(quantity, '_', ' ');
  return {.covariate = hypothesis.candidate.covariate,
          .quantity = quantity,
          .scope = name_of(hypothesis.candidate.owner, calibration),
          .amplitude = hypothesis.test.visible * noise,
          .unit = "m",
          .p_value = p_value_of(hypothesis, diagnosis),
          .gain = hypothesis.gains,
          .accepted = hypothesis.accepted};
}

std::string reason_of(const Limit& limit, const std::string& resolvable_by) {
  const std::string needs = resolvable_by.empty() ? "" : "; resolvable by: " + resolvable_by;
  if (!std::isfinite(limit.size))
    return "in these data its effect is fully absorbed by the other parameters" + needs;
  return fmt::format(
      "jointly with the other parameters, an effect below {:.0f} mm (RMS of ranges) is not detectable{}",
      1e3 * limit.size, needs);
}

/// The deviations that all lasers have in common over a covariate: their RMS and least p-value.
UnnamedFinding common_deviation(const ProfileComparison& left, const std::string& covariate) {
  double square = 0;
  double p_value = 1;
  for (const Profile& profile : left.profiles) {
    if (profile.covariate != covariate) continue;
    square += profile.share * profile.rms * profile.rms;
    p_value = std::min(p_value, profile.p_value);
  }
  return {.covariate = covariate,
          .quantity = "range",
          .scope = kScanner,
          .amplitude = std::sqrt(square),
          .unit = "m",
          .p_value = p_value,
          .gain = {}};
}

UnnamedFinding deviation_of(const Profile& profile, const Calibration& calibration) {
  return {.covariate = profile.covariate,
          .quantity = "range",
          .scope = scope_of(profile, calibration),
          .amplitude = profile.rms,
          .unit = "m",
          .p_value = profile.p_value,
          .gain = {}};
}

/// Adds the systematic residuals of the extended model over covariates without an unnamed finding: each
/// deviation once, by the covariate that explains most of it.
void add_left_over(const ProfileComparison& left, const Calibration& calibration, double visible,
                   Findings& all) {
  for (const Profile& profile : left.profiles) {
    if (!profile.is_significant() || profile.is_shadow || profile.rms < visible) continue;
    UnnamedFinding one =
        profile.is_common ? common_deviation(left, profile.covariate) : deviation_of(profile, calibration);
    const bool is_known = std::ranges::any_of(all.unnamed, [&](const UnnamedFinding& known) {
      return known.covariate == one.covariate && (known.scope == one.scope || known.scope == "plate");
    });
    if (!is_known) all.unnamed.push_back(std::move(one));
  }
}

/// Significant deviations from the simulation, of the incoming or the extended model.
std::vector<ResidualDeparture> departures_of(const Diagnosis& diagnosis, const Calibration& calibration) {
  std::vector<ResidualDeparture> all;
  for (const Profile& before : diagnosis.left_before.profiles) {
    const auto after = std::ranges::find_if(diagnosis.left_after.profiles, [&](const Profile& other) {
      return other.laser == before.laser && other.covariate == before.covariate;
    });
    const bool is_there = after != diagnosis.left_after.profiles.end();
    if (!before.is_significant() && !(is_there && after->is_significant())) continue;
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
  return profile.laser == kAllLasers ? kScanner : calibration.lasers[profile.laser].name;
}

Findings findings_of(const Diagnosis& diagnosis, const Calibration& calibration, const TermRegistry& terms,
                     const SelectionSettings& settings, double noise) {
  Findings all{.findings = causes_of(diagnosis, calibration, terms, settings.odds, noise),
               .unnamed = {},
               .departures = departures_of(diagnosis, calibration),
               .unobservable = {},
               .gain = diagnosis.gains,
               .before_p = diagnosis.left_before.p_value,
               .after_p = diagnosis.left_after.p_value};
  for (const Hypothesis& hypothesis : diagnosis.hypotheses) {
    if (!hypothesis.candidate.is_cause())
      all.unnamed.push_back(unnamed_of(hypothesis, calibration, diagnosis, noise));
  }
  add_left_over(diagnosis.left_after, calibration, settings.visible * noise, all);
  for (const Limit& limit : diagnosis.unobservable) {
    std::vector<std::string> needs = {showing(diagnosis.proposals, limit.name, limit.size),
                                      resolvable_by(limit.name, terms)};
    std::erase(needs, std::string());
    all.unobservable.push_back({.parameter = limit.name,
                                .reason = reason_of(limit, fmt::format("{}", fmt::join(needs, "; "))),
                                .combination = limit.combination});
  }
  for (const std::string& cause : diagnosis.unshared) {
    all.unobservable.push_back(
        {.parameter = cause,
         .reason =
             terms.get(cause)->info().counts_from == CountsFrom::kRunsEpoch
                 ? "it depends on the time since the recording began: diagnose one recording by itself"
                 : "it depends on the plate's angle, whose zero was lost between the recordings: diagnose one recording by itself",
         .combination = {}});
  }
  return all;
}

}  // namespace crisp::diagnose
