// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/diagnose/model/clock_lines.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include <crisp/sensor_model.hpp>

#include "plugins/diagnose/model/candidate_search.hpp"
#include "plugins/diagnose/model/candidates.hpp"
#include "tests/support/built_in_terms.hpp"

namespace crisp {
namespace {

using namespace crisp::diagnose;
using namespace crisp::estimate;

constexpr double kMiddle = 5;  // [s] of the recording

/// The nominal calibration with lines of the clocks of the first and the third laser.
struct Lines {
  Calibration calibration = nominal_calibration(default_rig());
  ParameterPrior prior;

  Lines() { add_clock_lines(calibration, prior, {3e-6, 0, 4e-6}, kMiddle, built_in_terms()); }
  SensorModel model() const { return SensorModel(calibration, built_in_terms()); }
};

/// η and the skew of the first laser, and the skew of the third, with these standard errors.
Outcome outcome_of(const Lines& lines, double first, double third) {
  Outcome outcome{.model = lines.model(), .free = {}, .covariance = {}, .unobservable = {}};
  for (const char* name : {"laser1.eta", "laser1.clock.skew.skew", "laser3.clock.skew.skew"})
    outcome.free.push_back(outcome.model.index(name));
  outcome.covariance = Eigen::Vector3d(1e-12, first * first, third * third).asDiagonal();
  return outcome;
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

TEST(ClockLines, AreOfTheBaseModelUnlessTheyAreExact) {
  Lines lines;
  const SensorModel model = lines.model();
  const std::size_t skew = model.index("laser1.clock.skew.skew");
  EXPECT_EQ(std::ranges::count(model.names(), "laser2.clock.skew.skew"), 0);
  EXPECT_EQ(model.values()[static_cast<Eigen::Index>(model.index("laser1.clock.skew.middle"))], kMiddle);
  EXPECT_TRUE(is_of_base_model(model, skew));
  EXPECT_DOUBLE_EQ(ranges_of(lines.prior, model, {skew})[0], 3e-6) << "and not a part of the bounds";
  EXPECT_DOUBLE_EQ(prior_means(lines.prior, model, {skew})[0], 0);
  Refinement fit{.outcome = outcome_of(lines, 1e-6, 1e-6)};
  EXPECT_EQ(base_of(fit), fit.outcome.free);
}

TEST(ClockLines, StayWithOtherTermsAndAreNoCandidates) {
  Lines lines;
  lines.calibration.lasers[0].terms.push_back(
      neutral_parameters(built_in_terms().get("mirror.cone")->info()));
  const Calibration plain = with_terms(lines.calibration, {}, built_in_terms());
  ASSERT_EQ(plain.lasers[0].terms.size(), 1U);
  EXPECT_EQ(plain.lasers[0].terms[0].term, "clock.skew");
  for (const Candidate& one : candidates(built_in_terms(), lines.calibration, {0, 10}))
    EXPECT_NE(one.term.term, "clock.skew");
}

TEST(ClockLines, GiveTheScoreTestsTheirPrior) {
  const Lines lines;
  const SensorModel model = with_one(lines.model(), lines.model().index("laser3.clock.skew.skew"), 2e-6);
  const std::vector<std::size_t> base = {model.index("laser3.eta"), model.index("laser3.clock.skew.skew")};
  const CandidateJacobian jacobian(model, base, {}, built_in_terms());
  quality::NormalEquations equations(2);
  equations.beams = 110;
  equations.degrees_of_freedom = 100;
  equations.weight = equations.stiffness = 100;
  equations.influence = 400;
  const double factor = equations.covariance_factor();
  jacobian.add_prior(equations, lines.prior);
  const double information = factor / (16e-12);
  EXPECT_DOUBLE_EQ(equations.matrix(1, 1), information);
  EXPECT_DOUBLE_EQ(equations.vector[1], information * 2e-6);
  EXPECT_DOUBLE_EQ(equations.chi2, information * 4e-12);
  EXPECT_EQ(equations.matrix(0, 0), 0) << "an η of which nothing is known from elsewhere";
}

TEST(ClockLines, AreLeftOutOfTheCalibration) {
  const Outcome outcome = without_clock_lines(outcome_of(Lines(), 1e-6, 2e-6), built_in_terms());
  EXPECT_EQ(outcome.model.names(), SensorModel(nominal_calibration(default_rig()), built_in_terms()).names());
  ASSERT_EQ(outcome.free.size(), 1U);
  EXPECT_EQ(outcome.model.names()[outcome.free[0]], "laser1.eta");
  EXPECT_EQ(outcome.covariance, Eigen::MatrixXd::Constant(1, 1, 1e-12));
}

TEST(ClockLines, AreReportedWhereSurfacesKnowThemBetter) {
  const Lines lines;
  const auto found = clock_lines(outcome_of(lines, 1.4e-6, 2.1e-6), lines.prior);
  ASSERT_TRUE(found);
  ASSERT_EQ(found->parameters.size(), 1U);
  EXPECT_EQ(found->parameters[0].name, "laser1.clock.skew.skew");
  EXPECT_DOUBLE_EQ(found->parameters[0].std_error, 1.4e-6);
  EXPECT_FALSE(clock_lines(outcome_of(lines, 1.6e-6, 2.1e-6), lines.prior));
}

}  // namespace
}  // namespace crisp
