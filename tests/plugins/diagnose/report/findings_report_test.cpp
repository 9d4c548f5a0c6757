// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/diagnose/report/findings_report.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <map>
#include <sstream>
#include <utility>

#include "tests/plugins/diagnose/hidden.hpp"

namespace crisp {
namespace {

using namespace crisp::diagnose;
using namespace crisp::estimate;
using namespace crisp::simulate;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

constexpr double kNoise = 0.012;  // [m]

/// A diagnosis without candidates: the model has no further terms.
Diagnosis without_candidates(const test::Recording& recording) {
  DiagnosisSettings settings;
  settings.rounds = 0;
  return test::diagnosed(recording, settings);
}

Findings reported(const Diagnosis& diagnosis) {
  return findings_of(diagnosis, diagnosis.after.outcome.model.calibration(), built_in_terms(), {}, kNoise);
}

test::Recording with_a_third_harmonic() {
  test::Recording recording = test::hidden(4, 3, office(), {});
  Measurements& beams = recording.made.beams;
  for (std::size_t i = 0; i < beams.size(); ++i) {
    if (beams.laser[i] == 2) beams.range[i] += 0.006F * std::sin(3 * beams.mirror_angle[i]);
  }
  return recording;
}

std::vector<UnnamedFinding> over_the_mirror(const Findings& findings) {
  std::vector<UnnamedFinding> found;
  for (const UnnamedFinding& finding : findings.unnamed) {
    if (finding.covariate == "mirror angle" && finding.scope == "laser3") found.push_back(finding);
  }
  return found;
}

TEST(FindingsReport, ListsTheResidualOfTheModelAsUnnamed) {
  Diagnosis diagnosis = without_candidates(with_a_third_harmonic());
  const Findings findings = reported(diagnosis);
  const auto found = over_the_mirror(findings);
  ASSERT_THAT(found, SizeIs(1));
  EXPECT_EQ(found[0].quantity, "range");
  EXPECT_EQ(found[0].unit, "m");
  EXPECT_NEAR(found[0].amplitude, 0.006 / std::sqrt(2), 0.0025) << "less what the planes absorb";
  EXPECT_LE(found[0].p_value, 0.01);
  EXPECT_FALSE(found[0].accepted) << "no term was added";
  EXPECT_THAT(in_words(found[0]), HasSubstr("no term of the catalogue explains it"));
}

TEST(FindingsReport, PrintsSizesInTheirUnitsWithPValues) {
  const auto words = [](const std::string& quantity, const std::string& unit) {
    return headline(UnnamedFinding{.covariate = "time",
                                   .quantity = quantity,
                                   .scope = "laser1",
                                   .amplitude = 0.002,
                                   .unit = unit,
                                   .p_value = 1e-4});
  };
  EXPECT_EQ(words("range", "m"), "unnamed: range of laser1 depends on time, by 2.000 mm, p = 0.0001");
  EXPECT_EQ(words("lag", "m"),
            "unnamed: lag of laser1 depends on time; ranges change by 2.000 mm, p = 0.0001");
  EXPECT_EQ(words("lag", "s"), "unnamed: lag of laser1 depends on time, by 2.0000 ms, p = 0.0001");
  EXPECT_EQ(words("plate angle", "rad"),
            "unnamed: plate angle of laser1 depends on time, by 0.1146 deg, p = 0.0001");
  EXPECT_EQ(headline(Finding{.cause = "scene.moving",
                             .scope = "scene",
                             .parameters = {{.name = "directions", .unit = "1", .value = 16}},
                             .p_value = 1e-3,
                             .accepted = true}),
            "scene.moving of scene: directions = 16, p = 0.001");
}

TEST(FindingsReport, ListsAnUnnamedDeviationOnce) {
  Diagnosis diagnosis = without_candidates(with_a_third_harmonic());
  diagnosis.hypotheses.push_back({.candidate = {.owner = 2,
                                                .term = {.term = "empirical.range_by_mirror_angle"},
                                                .name = "laser3.empirical.range_by_mirror_angle",
                                                .covariate = "mirror angle"},
                                  .test = {},
                                  .competitors = {},
                                  .gains = {},
                                  .accepted = false});
  EXPECT_THAT(over_the_mirror(reported(diagnosis)), SizeIs(1));
}

TEST(FindingsReport, PrintsWhyACauseWasRejected) {
  Diagnosis diagnosis = without_candidates(with_a_third_harmonic());
  Hypothesis hypothesis{.candidate = {.owner = 2,
                                      .term = {.term = "range.step"},
                                      .name = "laser3.range.step",
                                      .family = "range.step"},
                        .test = {},
                        .competitors = {},
                        .gains = {},
                        .accepted = false};
  diagnosis.hypotheses = {hypothesis};
  ASSERT_THAT(reported(diagnosis).findings, SizeIs(1));
  EXPECT_THAT(in_words(reported(diagnosis).findings[0]),
              HasSubstr("rejected: it does not improve the fit on held-out data"));
  diagnosis.hypotheses[0].rejected = "it explains less than the residual";
  EXPECT_THAT(in_words(reported(diagnosis).findings[0]),
              HasSubstr("rejected: it explains less than the residual"));
}

TEST(FindingsReport, HasNoCauseThatTheLevelOfAnotherExplains) {
  Diagnosis diagnosis = without_candidates(with_a_third_harmonic());
  const auto of_laser3 = [](const std::string& term, const std::string& level, double of_offset) {
    return Hypothesis{
        .candidate =
            {.owner = 2, .term = {.term = term}, .name = "laser3." + term, .family = term, .level = level},
        .test = {},
        .competitors =
            {{.name = "laser3.range.offset", .behind = of_offset, .term = "range.offset", .owner = 2}},
        .gains = {}};
  };
  diagnosis.hypotheses = {of_laser3("range.cyclic", "", -20),
                          of_laser3("range.intensity", "range.offset", 99)};
  const Findings findings = reported(diagnosis);
  ASSERT_THAT(findings.findings, SizeIs(1));
  EXPECT_EQ(findings.findings[0].cause, "range.intensity");
  diagnosis.hypotheses[0].competitors[0].behind = 20;
  EXPECT_THAT(reported(diagnosis).findings, SizeIs(2)) << "no constant does that";
  diagnosis.hypotheses[0].competitors[0] = {.behind = -20, .term = "range.offset", .owner = 1};
  EXPECT_THAT(reported(diagnosis).findings, SizeIs(2)) << "of another laser";
}

TEST(FindingsReport, HasNoCauseThatTheFamilyOfAnotherExplains) {
  Diagnosis diagnosis = without_candidates(with_a_third_harmonic());
  const auto of_laser3 = [](const std::string& term, double bic, const std::string& rival, double behind) {
    return Hypothesis{
        .candidate = {.owner = 2, .term = {.term = term}, .name = "laser3." + term, .family = term},
        .test = {.bic = bic},
        .competitors = {{.name = "laser3." + rival, .behind = behind, .term = rival, .owner = 2}},
        .gains = {}};
  };
  const auto causes = [&] {
    std::vector<std::string> names;
    for (const Finding& finding : reported(diagnosis).findings) names.push_back(finding.cause);
    return names;
  };
  diagnosis.hypotheses = {of_laser3("mirror.eccentricity", 200, "range.incidence", -5),
                          of_laser3("range.incidence", 700, "range.offset", 60)};
  EXPECT_THAT(causes(), ElementsAre("range.incidence"));
  std::ranges::reverse(diagnosis.hypotheses);
  EXPECT_THAT(causes(), ElementsAre("range.incidence")) << "in any order";
  diagnosis.hypotheses[0].competitors[0] = {.behind = -5, .term = "mirror.eccentricity", .owner = 2};
  EXPECT_THAT(causes(), ElementsAre("range.incidence"))
      << "the more significant one, where each explains both";
  diagnosis.hypotheses[1].competitors[0].behind = 5;
  EXPECT_THAT(causes(), SizeIs(2)) << "it explains more by itself";
  diagnosis.hypotheses[1].competitors[0] = {.behind = -5, .term = "range.incidence", .owner = 1};
  EXPECT_THAT(causes(), SizeIs(2)) << "of another laser";
}

TEST(FindingsReport, LeavesOutInsignificantAndSmallDeviations) {
  const Diagnosis diagnosis = without_candidates(with_a_third_harmonic());
  Diagnosis chance = diagnosis;
  for (Profile& profile : chance.left_after.profiles) profile.p_value = 0.015;
  EXPECT_THAT(reported(chance).unnamed, IsEmpty());
  Diagnosis bumps = diagnosis;
  for (Profile& profile : bumps.left_after.profiles) profile.rms = 0.9 * SelectionSettings{}.visible * kNoise;
  EXPECT_THAT(reported(bumps).unnamed, IsEmpty());
}

TEST(FindingsReport, ListsDeviationsFromTheSimulation) {
  const Findings findings = reported(without_candidates(with_a_third_harmonic()));
  const auto found = std::ranges::find_if(findings.departures, [](const ResidualDeparture& departure) {
    return departure.covariate == "mirror angle" && departure.scope == "laser3";
  });
  ASSERT_NE(found, findings.departures.end());
  EXPECT_EQ(found->quantity, "range");
  EXPECT_NEAR(found->amplitude, 0.006 / std::sqrt(2), 0.0025) << "less what the planes absorb";
  EXPECT_LE(found->p_value, 0.01);
  EXPECT_EQ(found->amplitude_after, found->amplitude) << "no term was added";
  const auto clean = reported(without_candidates(test::hidden(4, 3, office(), {})));
  EXPECT_THAT(clean.departures, IsEmpty());
}

/// Diagnosis of an offset of one laser, a cone of another, and an unmodeled error of the third.
const Diagnosis& of_two_causes_and_a_shape() {
  static const Diagnosis diagnosis = [] {
    test::Recording recording =
        test::hidden(7, 4, office(), {{"laser1.range.offset", {0.012}}, {"laser2.mirror.cone", {0.004}}});
    Measurements& beams = recording.made.beams;
    for (std::size_t i = 0; i < beams.size(); ++i) {
      if (beams.laser[i] == 2) beams.range[i] += 0.012F * std::sin(3 * beams.mirror_angle[i]);
    }
    DiagnosisSettings settings;
    settings.beams = 60'000;
    return test::diagnosed(recording, settings);
  }();
  return diagnosis;
}

std::map<std::string, double> shares_in(const Findings& findings) {
  std::map<std::string, double> shares;
  for (const Finding& finding : findings.findings) shares[finding.cause] = finding.explained_fraction;
  return shares;
}

TEST(FindingsReport, SharesRelateToTheWholeResidual) {
  const Diagnosis& all = of_two_causes_and_a_shape();
  const auto shares = shares_in(reported(all));
  ASSERT_THAT(shares,
              testing::UnorderedElementsAre(testing::Key("range.offset"), testing::Key("mirror.cone")));
  double named = 0;
  for (const auto& [cause, share] : shares) named += share;
  EXPECT_LT(named, 0.9) << "the fitted shape has a share, too";
  EXPECT_GT(named, 0.2);

  // The total is the same whether the shape is described or not.
  Diagnosis fewer = all;
  std::erase_if(fewer.hypotheses, [](const Hypothesis& one) { return !one.candidate.is_cause(); });
  ASSERT_THAT(fewer.hypotheses, SizeIs(2));
  for (const auto& [cause, share] : shares_in(reported(fewer))) {
    EXPECT_NEAR(share, shares.at(cause), 0.15 * shares.at(cause)) << cause;
  }
}

TEST(FindingsReport, AttributesNearlyAllOfTheirEffectToTwoCauses) {
  const auto recording =
      test::hidden(8, 4, office(), {{"laser1.range.offset", {0.012}}, {"laser2.mirror.cone", {0.004}}});
  const Diagnosis diagnosis = test::diagnosed(recording);
  ASSERT_THAT(test::names_in(diagnosis),
              testing::UnorderedElementsAre("laser1.range.offset", "laser2.mirror.cone"));
  double named = 0;
  for (const auto& [cause, share] : shares_in(reported(diagnosis))) named += share;
  EXPECT_GT(named, 0.9);
  EXPECT_LE(named, 1 + 1e-9);
}

TEST(FindingsReport, NamesTheCompetitorOfTheBayesFactor) {
  const Findings findings = reported(of_two_causes_and_a_shape());
  for (const Finding& finding : findings.findings) {
    ASSERT_FALSE(finding.alternatives.empty()) << finding.cause;
    const OtherCause& next = finding.alternatives.front();
    EXPECT_EQ(next.log10_bayes_factor, finding.log10_bayes_factor) << "the most likely";
    EXPECT_TRUE(std::ranges::is_sorted(finding.alternatives, {}, &OtherCause::log10_bayes_factor));
    EXPECT_THAT(in_words(finding), HasSubstr("Bayes factor (BIC) against the next cause, " + next.cause +
                                             " of " + next.scope + ", 10^"));
  }
}

/// The slope 4.9 in "laser2.lambda + 4.9 * laser2.mount.tangential_offset.y, …"; NaN if it is not there.
double slope_in(const std::string& combination, const std::string& parameter) {
  const auto at = combination.find(parameter + " ");
  if (at == std::string::npos) return std::nan("");
  std::istringstream text(combination.substr(at + parameter.size() + 1));
  char sign = 0;
  double slope = 0;
  text >> sign >> slope;
  return sign == '-' ? -slope : slope;
}

/// Error of an estimate, and its standard error.
std::pair<double, double> shift_of(const Outcome& outcome, const Calibration& truth,
                                   const std::string& name) {
  const SensorModel model(truth, built_in_terms());
  const auto value = [&](const SensorModel& of) {
    return of.values()[std::ranges::find(of.names(), name) - of.names().begin()];
  };
  for (std::size_t k = 0; k < outcome.free.size(); ++k) {
    const auto i = static_cast<Eigen::Index>(k);
    if (outcome.model.names()[outcome.free[k]] != name) continue;
    return {value(outcome.model) - value(model), std::sqrt(outcome.covariance(i, i))};
  }
  return {std::nan(""), 0};
}

std::string combination_with(const Findings& findings, const std::string& cause) {
  const auto found = std::ranges::find(findings.unobservable, cause, &Unobservable::parameter);
  return found == findings.unobservable.end() ? "it is not reported as unobservable" : found->combination;
}

TEST(FindingsReport, ReportsIdentifiableCombinationsOfUnobservableParameters) {
  constexpr double kOffset = 0.01;  // [m]
  const std::string hidden = "laser2.mount.tangential_offset";
  DiagnosisSettings settings;
  settings.rounds = 1;
  settings.beams = 40'000;
  const auto recording = test::hidden(53, 3, office(), {{hidden, {kOffset}}});
  const Diagnosis diagnosis = test::diagnosed(recording, settings);
  const Findings findings = reported(diagnosis);

  // If λ + 5 y is identifiable, λ is biased by 5 y in a model without y.
  const std::string combination = combination_with(findings, hidden);
  for (const std::string name : {"laser2.lambda", "laser2.alpha"}) {
    const auto [shift, error] = shift_of(diagnosis.after.outcome, recording.scanner.truth, name);
    const double predicted = slope_in(combination, name) * kOffset;
    EXPECT_NEAR(shift, predicted, 4 * error + 0.02 * std::abs(predicted)) << name << " in " << combination;
    EXPECT_GT(std::abs(predicted), 0.03) << name;
  }
  // Without a reversal, backlash is equivalent to a rotation of the whole room.
  EXPECT_EQ(combination_with(findings, "encoder.backlash"), "");
}

}  // namespace
}  // namespace crisp
