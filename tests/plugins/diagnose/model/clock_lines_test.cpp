// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/diagnose/model/clock_lines.hpp"

#include <gtest/gtest.h>

#include <crisp/sensor_model.hpp>

#include "tests/support/built_in_terms.hpp"

namespace crisp {
namespace {

using namespace crisp::diagnose;
using namespace crisp::estimate;

constexpr double kMiddle = 5;  // [s] of the recording
constexpr double kLeast = 20;  // of χ²

/// The second laser's drift, and its fit with this skew and growth, known to 1 ppm and 0.2 ppm/s.
struct Fit {
  Hypothesis drift;
  Outcome outcome;
};

Fit fit_of(double skew, double growth) {
  TermParameters term = neutral_parameters(built_in_terms().get("clock.drift")->info());
  Hypothesis drift;
  drift.candidate = {.owner = 1, .term = term, .name = "laser2.clock.drift", .family = "clock.drift"};
  term.parameters[0].value = skew;
  term.parameters[1].value = growth;
  Calibration calibration = nominal_calibration(default_rig());
  calibration.lasers[1].terms.push_back(term);
  Outcome outcome{
      .model = SensorModel(calibration, built_in_terms()), .free = {}, .covariance = {}, .unobservable = {}};
  const auto& names = outcome.model.names();
  for (const std::string name : {"laser2.clock.drift.skew", "laser2.clock.drift.drift"}) {
    outcome.free.push_back(static_cast<std::size_t>(std::ranges::find(names, name) - names.begin()));
  }
  outcome.covariance = Eigen::Vector2d(1e-12, 0.04e-12).asDiagonal();
  return {.drift = drift, .outcome = outcome};
}

/// Whether it corrects the clock's line, whose skew is known to 6 ppm.
bool is_correction(double skew, double growth, double skew_error = 6e-6) {
  const Fit fit = fit_of(skew, growth);
  std::vector<Hypothesis> hypotheses = {fit.drift};
  mark_clock_lines(hypotheses, fit.outcome, {0, skew_error, 0}, kMiddle, kLeast);
  return hypotheses.front().is_clock_line;
}

TEST(ClockLines, AreCorrectedByASkewWithinTheirErrors) {
  EXPECT_TRUE(is_correction(17e-6, 0));
  EXPECT_TRUE(is_correction(-17e-6, 0));
  EXPECT_TRUE(is_correction(19e-6, -0.5e-6)) << "the mean skew counts: 16.5 ppm";
  Fit vague = fit_of(24e-6, 0);
  vague.outcome.covariance(0, 0) = 36e-12;
  std::vector<Hypothesis> hypotheses = {vague.drift};
  mark_clock_lines(hypotheses, vague.outcome, {0, 6e-6, 0}, kMiddle, kLeast);
  EXPECT_TRUE(hypotheses.front().is_clock_line) << "24 ppm, by 8.5 ppm of both errors";
}

TEST(ClockLines, DoNotExplainALargerOrAChangingSkew) {
  EXPECT_FALSE(is_correction(19e-6, 0));
  EXPECT_TRUE(is_correction(5e-6, 0.88e-6)) << "by 4.4 standard errors, which no cause is selected for";
  EXPECT_FALSE(is_correction(5e-6, 0.91e-6)) << "the skew changes";
  EXPECT_FALSE(is_correction(5e-6, 0, 0)) << "an exact clock";
}

TEST(ClockLines, OfAnotherTermOrARejectedDriftAreNone) {
  const Fit fit = fit_of(5e-6, 0);
  std::vector<Hypothesis> hypotheses = {fit.drift, fit.drift};
  hypotheses[0].accepted = false;
  hypotheses[1].candidate.term.term = "mirror.period";
  mark_clock_lines(hypotheses, fit.outcome, {6e-6, 6e-6, 6e-6}, kMiddle, kLeast);
  EXPECT_FALSE(hypotheses[0].is_clock_line);
  EXPECT_FALSE(hypotheses[1].is_clock_line);
  EXPECT_FALSE(clock_lines(hypotheses, fit.outcome));
}

TEST(ClockLines, AreReportedWithTheirSkews) {
  const Fit fit = fit_of(5e-6, 0);
  std::vector<Hypothesis> hypotheses = {fit.drift};
  mark_clock_lines(hypotheses, fit.outcome, {6e-6, 6e-6, 6e-6}, kMiddle, kLeast);
  const auto found = clock_lines(hypotheses, fit.outcome);
  ASSERT_TRUE(found);
  ASSERT_EQ(found->parameters.size(), 1U);
  EXPECT_EQ(found->parameters[0].name, "laser2.clock.drift.skew");
  EXPECT_DOUBLE_EQ(found->parameters[0].value, 5e-6);
  EXPECT_DOUBLE_EQ(found->parameters[0].std_error, 1e-6);
}

TEST(ClockLines, HaveTheErrorsOfBothClocks) {
  const auto map_of = [](const std::string& device, double error) {
    return ClockMap{.device = device, .pieces = ClockPieces(ClockPiece{}), .skew_std_error = error};
  };
  const Rig rig = default_rig();
  const auto errors =
      skew_errors(rig, {{"laser1", map_of("laser1", 3e-6)}, {"plate", map_of("plate", 4e-6)}});
  ASSERT_EQ(errors.size(), rig.lasers.size());
  EXPECT_DOUBLE_EQ(errors[0], 5e-6);
  EXPECT_DOUBLE_EQ(errors[1], 4e-6) << "a clock without a map is exact";
}

}  // namespace
}  // namespace crisp
