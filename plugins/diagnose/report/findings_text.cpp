// SPDX-License-Identifier: BSD-3-Clause
// Text output of findings.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include "pipeline/data/goodness_of_fit_tests.hpp"
#include "pipeline/data/shown_unit.hpp"
#include "plugins/diagnose/report/findings_report.hpp"

namespace crisp::diagnose {
namespace {

std::string with_unit(const Parameter& parameter) {
  const bool is_long = parameter.unit == "s" && !(std::abs(parameter.value) < 1);
  const data::ShownUnit as = is_long ? data::ShownUnit{.name = "s"} : data::shown_unit(parameter.unit);
  const std::string error =
      parameter.std_error > 0 ? fmt::format(" ± {:.2g}", parameter.std_error * as.factor) : "";
  return fmt::format("{} = {:.4g}{}{}{}", parameter.name, parameter.value * as.factor, error,
                     as.name.empty() ? "" : " ", as.name);
}

/// Size of an unnamed finding. For a term of the model it is the effect on the ranges, whatever the term's
/// unit.
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
  if (gains.empty()) return "\n  no gain measured on held-out data";
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

/// Competing hypothesis of the Bayes factor.
std::string next_in_words(const Finding& finding) {
  if (finding.alternatives.empty()) return "the next cause";
  const OtherCause& next = finding.alternatives.front();
  if (next.log10_bayes_factor > finding.log10_bayes_factor) return "no named cause";
  return fmt::format("the next cause, {} of {},", next.cause, next.scope);
}

/// Table of significant deviations from the simulation: a line per laser, a column per covariate.
std::string profiles_in_words(const ProfileComparison& left, const Calibration& calibration) {
  std::vector<std::string> scopes;
  std::vector<std::string> covariates;
  std::map<std::pair<std::string, std::string>, const Profile*> significant;
  for (const Profile& profile : left.profiles) {
    if (!profile.is_significant()) continue;
    const std::string scope = scope_of(profile, calibration);
    if (std::ranges::find(scopes, scope) == scopes.end()) scopes.push_back(scope);
    if (std::ranges::find(covariates, profile.covariate) == covariates.end())
      covariates.push_back(profile.covariate);
    significant[{scope, profile.covariate}] = &profile;
  }
  if (significant.empty()) return "  no mean residual deviates significantly from the simulation\n";
  std::string words = fmt::format("  {:<10}", "[mm RMS]");
  for (const std::string& covariate : covariates) words += fmt::format("{:>14}", covariate);
  for (const std::string& scope : scopes) {
    words += fmt::format("\n  {:<10}", scope);
    double least = 1;
    for (const std::string& covariate : covariates) {
      const auto found = significant.find({scope, covariate});
      const bool is_significant = found != significant.end();
      words += fmt::format("{:>14}", is_significant ? fmt::format("{:.3f}", found->second->rms * 1e3) : "-");
      if (is_significant) least = std::min(least, found->second->p_value);
    }
    words += "   " + data::chance_in_words(least);
  }
  return words + "\n";
}

/// One-line summary.
std::string in_short(const Findings& findings) {
  std::vector<std::string> parts;
  for (const Finding& finding : findings.findings) {
    if (finding.accepted) parts.push_back(fmt::format("{} of {}", finding.cause, finding.scope));
  }
  const std::size_t named = parts.size();
  for (const UnnamedFinding& finding : findings.unnamed) {
    parts.push_back(
        fmt::format("unnamed: {} of {} over {}", finding.quantity, finding.scope, finding.covariate));
  }
  if (parts.empty()) return "summary: no cause identified\n";
  return fmt::format("summary: {}{}\n", named == 0 ? "no cause identified; " : "", fmt::join(parts, ", "));
}

/// Unobservable and untested causes, with their detection limits.
std::string untold_in_words(const Diagnosis& diagnosis) {
  std::string words;
  std::vector<std::string> limits;
  for (const Limit& limit : diagnosis.unobservable) {
    limits.push_back(std::isfinite(limit.size)
                         ? fmt::format("{} (below {:.0f} mm)", limit.name, 1e3 * limit.size)
                         : fmt::format("{} (of any size)", limit.name));
  }
  if (!limits.empty()) words += fmt::format("\nunobservable in these data: {}", fmt::join(limits, ", "));
  if (!diagnosis.unshared.empty()) {
    words +=
        fmt::format("\nnot tested, since recordings do not share them (diagnose one recording by itself): {}",
                    fmt::join(diagnosis.unshared, ", "));
  }
  return words;
}

}  // namespace

std::string headline(const Finding& finding) {
  std::string words =
      fmt::format("{} of {}{}: ", finding.cause, finding.scope, finding.accepted ? "" : " (rejected)");
  for (const Parameter& parameter : finding.parameters) words += with_unit(parameter) + ", ";
  return words + data::chance_in_words(finding.p_value);
}

std::string headline(const UnnamedFinding& finding) {
  const bool has_gain = !finding.gain.empty();
  return fmt::format("unnamed: {} of {} depends on {}{}, {}{}", finding.quantity, finding.scope,
                     finding.covariate, by_how_much(finding), data::chance_in_words(finding.p_value),
                     has_gain && !finding.accepted ? " (rejected)" : "");
}

std::string in_words(const Finding& finding) {
  std::string words = headline(finding);
  if (finding.explained_fraction > 0) {
    const bool is_noise = finding.cause.starts_with("noise.");
    words += fmt::format("\n  explains {:.0f} % of {}", 100 * finding.explained_fraction,
                         is_noise ? "the gain of all its noise components" : "the systematic residual");
  }
  if (std::isfinite(finding.log10_bayes_factor)) {
    words += fmt::format("\n  Bayes factor (BIC) against {} 10^{:.0f}", next_in_words(finding),
                         finding.log10_bayes_factor);
  }
  if (!finding.confounded_with.empty()) {
    words += fmt::format("; in these data not resolvable from {}", fmt::join(finding.confounded_with, ", "));
  }
  if (!finding.resolvable_by.empty()) {
    words += fmt::format("\n  resolvable by: {}", fmt::join(finding.resolvable_by, "; "));
  }
  if (!finding.accepted) words += "\n  rejected: " + finding.rejection_reason();
  return words + gain_in_words(finding.gain);
}

std::string in_words(const UnnamedFinding& finding) {
  if (finding.gain.empty()) return headline(finding) + "\n  no term of the catalogue explains it";
  return headline(finding) + gain_in_words(finding.gain);
}

std::string in_words(const Diagnosis& diagnosis, const Findings& findings) {
  std::string words = in_short(findings);
  words += "mean residuals that deviate from the simulated scanner's:\n";
  words += profiles_in_words(diagnosis.left_before, diagnosis.after.outcome.model.calibration());
  for (const Finding& finding : findings.findings) words += in_words(finding) + "\n";
  for (const UnnamedFinding& finding : findings.unnamed) words += in_words(finding) + "\n";
  const auto accepted = std::ranges::count_if(diagnosis.hypotheses, &Hypothesis::accepted);
  if (accepted > 1) words += "all accepted effects jointly:" + gain_in_words(findings.gain) + "\n";
  for (const EstimatorArtifact& artifact : findings.artifacts) {
    words += fmt::format("estimator artifact ({}): {}\n", artifact.name, artifact.reason);
    for (const Parameter& parameter : artifact.parameters) words += "  " + with_unit(parameter) + "\n";
  }
  return words + data::fit_statistics_text(findings) + untold_in_words(diagnosis);
}

}  // namespace crisp::diagnose
