// SPDX-License-Identifier: BSD-3-Clause
// What is printed of findings.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include "pipeline/data/likeness.hpp"
#include "pipeline/data/shown_unit.hpp"
#include "plugins/diagnose/report.hpp"

namespace crisp {
namespace {

std::string with_unit(const Parameter& parameter) {
  const bool is_long = parameter.unit == "s" && !(std::abs(parameter.value) < 1);
  const ShownUnit as = is_long ? ShownUnit{.name = "s"} : shown_unit(parameter.unit);
  const std::string error =
      parameter.std_error > 0 ? fmt::format(" ± {:.2g}", parameter.std_error * as.factor) : "";
  return fmt::format("{} = {:.4g}{}{}{}", parameter.name, parameter.value * as.factor, error,
                     as.name.empty() ? "" : " ", as.name);
}

/// Of what is off; what a model's term moves is told by how much ranges change for it, whatever its unit.
std::string by_how_much(const UnnamedFinding& finding) {
  if (finding.unit == "rad")
    return fmt::format(", by {:.4f} deg", finding.amplitude * 180 / std::numbers::pi);
  if (finding.unit == "s") return fmt::format(", by {:.4f} ms", finding.amplitude * 1e3);
  if (finding.unit == "1") return fmt::format(", by {:.3f}", finding.amplitude);
  const std::array lengths = {"range", "base", "noise"};
  const bool is_length = std::ranges::find(lengths, finding.quantity) != lengths.end();
  return fmt::format("{} {:.3f} mm", is_length ? ", by" : "; ranges change by", finding.amplitude * 1e3);
}

std::string gain_in_words(const std::vector<Gain>& gains) {
  if (gains.empty()) return "\n  no held-out data say what that brings";
  std::string words;
  for (const Gain& gain : gains) {
    const double factor = gain.unit == "m" ? 1e3 : gain.unit == "s" ? 1e6 : 1;
    const std::string unit = gain.unit == "m" ? "mm" : gain.unit == "s" ? "us" : gain.unit;
    words += fmt::format("\n  {:<32}{:>10.4f} -> {:>8.4f} {:<3}  change {:+.4f} to {:+.4f}", gain.metric,
                         gain.before * factor, gain.after * factor, unit, gain.ci95[0] * factor,
                         gain.ci95[1] * factor);
  }
  return words;
}

/// What the odds are against.
std::string next_in_words(const Finding& finding) {
  if (finding.alternatives.empty()) return "the next cause";
  const OtherCause& next = finding.alternatives.front();
  if (next.log10_odds > finding.log10_odds) return "no named cause";
  return fmt::format("the next cause, {} of {},", next.cause, next.scope);
}

/// How much departs from the simulation: a line for each laser, a column for each covariate.
std::string profiles_in_words(const SideBySide& left, const Calibration& calibration) {
  std::vector<std::string> scopes;
  std::vector<std::string> covariates;
  std::map<std::pair<std::string, std::string>, const Profile*> departing;
  for (const Profile& profile : left.profiles) {
    if (!profile.departs()) continue;
    const std::string scope = scope_of(profile, calibration);
    if (std::ranges::find(scopes, scope) == scopes.end()) scopes.push_back(scope);
    if (std::ranges::find(covariates, profile.covariate) == covariates.end())
      covariates.push_back(profile.covariate);
    departing[{scope, profile.covariate}] = &profile;
  }
  if (departing.empty()) return "  no mean of the residuals departs from the simulation\n";
  std::string words = fmt::format("  {:<10}", "[mm RMS]");
  for (const std::string& covariate : covariates) words += fmt::format("{:>14}", covariate);
  for (const std::string& scope : scopes) {
    words += fmt::format("\n  {:<10}", scope);
    double least = 1;
    for (const std::string& covariate : covariates) {
      const auto found = departing.find({scope, covariate});
      const bool departs = found != departing.end();
      words += fmt::format("{:>14}", departs ? fmt::format("{:.3f}", found->second->rms * 1e3) : "-");
      if (departs) least = std::min(least, found->second->p_value);
    }
    words += "   " + chance_in_words(least);
  }
  return words + "\n";
}

/// What came out, in a line.
std::string in_short(const Findings& findings) {
  std::vector<std::string> parts;
  for (const Finding& finding : findings.findings) {
    if (finding.accepted) parts.push_back(fmt::format("{} of {}", finding.cause, finding.scope));
  }
  const std::size_t named = parts.size();
  for (const UnnamedFinding& finding : findings.unnamed) {
    parts.push_back(
        fmt::format("unnamed: {} of {} over the {}", finding.quantity, finding.scope, finding.covariate));
  }
  if (parts.empty()) return "in short: no cause is found\n";
  return fmt::format("in short: {}{}\n", named == 0 ? "no cause is found; " : "", fmt::join(parts, ", "));
}

/// Causes that these data do not tell, and what those would have to be like.
std::string untold_in_words(const Diagnosis& diagnosis) {
  std::string words;
  std::vector<std::string> limits;
  for (const Limit& limit : diagnosis.unobservable) {
    limits.push_back(std::isfinite(limit.size)
                         ? fmt::format("{} (below {:.0f} mm)", limit.name, 1e3 * limit.size)
                         : fmt::format("{} (of any size)", limit.name));
  }
  if (!limits.empty()) words += fmt::format("\nnot to be told by these data: {}", fmt::join(limits, ", "));
  if (!diagnosis.unshared.empty()) {
    words += fmt::format("\nnot looked for, as recordings cannot share them (diagnose one by itself): {}",
                         fmt::join(diagnosis.unshared, ", "));
  }
  return words;
}

}  // namespace

std::string headline(const Finding& finding) {
  std::string words =
      fmt::format("{} of {}{}: ", finding.cause, finding.scope, finding.accepted ? "" : " (refused)");
  for (const Parameter& parameter : finding.parameters) words += with_unit(parameter) + ", ";
  return words + chance_in_words(finding.p_value);
}

std::string headline(const UnnamedFinding& finding) {
  const bool has_gain = !finding.gain.empty();
  return fmt::format("unnamed: {} of {} depends on the {}{}, {}{}", finding.quantity, finding.scope,
                     finding.covariate, by_how_much(finding), chance_in_words(finding.p_value),
                     has_gain && !finding.accepted ? " (refused)" : "");
}

std::string in_words(const Finding& finding) {
  std::string words = headline(finding);
  if (finding.explained_fraction > 0) {
    const bool is_noise = finding.cause.starts_with("noise.");
    words += fmt::format("\n  explains {:.0f} % of {}", 100 * finding.explained_fraction,
                         is_noise ? "what all laws of its noise bring" : "the departure");
  }
  if (std::isfinite(finding.log10_odds)) {
    words += fmt::format("\n  odds against {} 10^{:.0f}", next_in_words(finding), finding.log10_odds);
  }
  if (!finding.confounded_with.empty()) {
    words += fmt::format("; these data cannot tell it from {}", fmt::join(finding.confounded_with, ", "));
  }
  if (!finding.told_apart_by.empty()) {
    words += fmt::format("\n  what would: {}", fmt::join(finding.told_apart_by, "; "));
  }
  if (!finding.accepted) words += "\n  refused: " + finding.refusal();
  return words + gain_in_words(finding.gain);
}

std::string in_words(const UnnamedFinding& finding) {
  if (finding.gain.empty()) return headline(finding) + "\n  no term that was tried takes it";
  return headline(finding) + gain_in_words(finding.gain);
}

std::string in_words(const Diagnosis& diagnosis, const Findings& findings) {
  std::string words = in_short(findings);
  words += "what is wrong: residuals against what the scanner simulated again shows\n";
  words += profiles_in_words(diagnosis.left_before, diagnosis.after.outcome.model.calibration());
  for (const Finding& finding : findings.findings) words += in_words(finding) + "\n";
  for (const UnnamedFinding& finding : findings.unnamed) words += in_words(finding) + "\n";
  const auto accepted = std::ranges::count_if(diagnosis.departures, &Departure::accepted);
  if (accepted > 1) words += "all that was accepted, together:" + gain_in_words(findings.gain) + "\n";
  for (const Artefact& artefact : findings.artefacts) {
    words += fmt::format("the estimator's own ({}): {}\n", artefact.name, artefact.reason);
    for (const Parameter& parameter : artefact.parameters) words += "  " + with_unit(parameter) + "\n";
  }
  return words + likeness_in_words(findings) + untold_in_words(diagnosis);
}

}  // namespace crisp
