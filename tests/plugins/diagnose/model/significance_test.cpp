// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/diagnose/model/significance.hpp"

#include <gtest/gtest.h>

#include "tests/support/built_in_terms.hpp"

namespace crisp {
namespace {

using namespace crisp::diagnose;
using namespace crisp::estimate;

/// A fit with range.offset and range.intensity of the first laser, at these estimates.
Outcome outcome(double offset, double a, double b) {
  Calibration calibration = nominal_calibration(default_rig());
  const auto add = [&](const std::string& name, const std::vector<double>& values) {
    TermParameters term = neutral_parameters(built_in_terms().get(name)->info());
    for (std::size_t p = 0; p < values.size(); ++p) term.parameters[p].value = values[p];
    calibration.lasers[0].terms.push_back(term);
  };
  add("range.offset", {offset});
  add("range.intensity", {a, b});
  Outcome result{
      .model = SensorModel(calibration, built_in_terms()), .free = {}, .covariance = {}, .unobservable = {}};
  const auto& names = result.model.names();
  for (const std::string name :
       {"laser1.tau", "laser1.range.offset.c", "laser1.range.intensity.a", "laser1.range.intensity.b"}) {
    result.free.push_back(static_cast<std::size_t>(std::ranges::find(names, name) - names.begin()));
  }
  result.covariance = 1e-6 * Eigen::MatrixXd::Identity(4, 4);
  result.covariance(2, 3) = result.covariance(3, 2) = 0.98e-6;
  return result;
}

Hypothesis of_first_laser(const std::string& term) {
  Hypothesis one;
  one.candidate.owner = 0;
  one.candidate.name = "laser1." + term;
  one.candidate.term = neutral_parameters(built_in_terms().get(term)->info());
  return one;
}

TEST(Significance, RejectsAnInsignificantTerm) {
  std::vector<Hypothesis> found = {of_first_laser("range.offset"), of_first_laser("range.intensity")};
  EXPECT_FALSE(reject_insignificant(found, outcome(0.004, 0.005, 0), built_in_terms(), 1e-3));
  EXPECT_TRUE(reject_insignificant(found, outcome(0.003, 0.005, 0), built_in_terms(), 1e-3))
      << "three standard errors";
  EXPECT_FALSE(found[0].accepted);
  EXPECT_NE(found[0].rejected, "");
  EXPECT_TRUE(found[1].accepted);
}

TEST(Significance, RecordsTheLastWaldTestOfEach) {
  std::vector<Hypothesis> found = {of_first_laser("range.offset")};
  reject_insignificant(found, outcome(0.004, 0.005, 0), built_in_terms(), 1e-3);
  reject_insignificant(found, outcome(0.003, 0.005, 0), built_in_terms(), 1e-3);
  ASSERT_EQ(found[0].tests.size(), 1U);
  EXPECT_EQ(found[0].tests[0].name, "Wald test");
  EXPECT_NEAR(found[0].tests[0].statistic, 9, 1e-9);
  EXPECT_NEAR(found[0].tests[0].p_value, 0.0027, 1e-4) << "of three standard errors";
  EXPECT_FALSE(found[0].tests[0].passed);
}

TEST(Significance, RejectsASmallCauseThatSeveralLasersShare) {
  const auto seen = [](const std::string& term, std::size_t laser, double visible) {
    Hypothesis one = of_first_laser(term);
    one.candidate.owner = laser;
    one.candidate.name = "laser" + std::to_string(laser + 1) + "." + term;
    one.test.visible = visible;
    return one;
  };
  std::vector<Hypothesis> found = {seen("range.intensity", 0, 0.03), seen("range.intensity", 2, 0.04),
                                   seen("range.offset", 0, 0.03),    seen("range.offset", 1, 0.11),
                                   seen("range.scale", 1, 0.01),     seen("range.cyclic", 0, 0.02),
                                   seen("range.cyclic", 1, 0.06),    seen("range.cyclic", 2, 0.01)};
  reject_scene_artifacts(found);
  const auto accepted = [&](std::size_t k) { return found.at(k).accepted; };
  EXPECT_FALSE(accepted(0) || accepted(1));
  EXPECT_NE(found[0].rejected, "");
  EXPECT_TRUE(accepted(2) && accepted(3)) << "one of them is large";
  EXPECT_TRUE(accepted(4)) << "a cause of one laser only";
  EXPECT_TRUE(accepted(6)) << "it is much larger in this laser";
  EXPECT_FALSE(accepted(5) || accepted(7)) << "what surfaces leave to the others";
}

TEST(Significance, TestsTheParametersOfATermJointly) {
  std::vector<Hypothesis> alike = {of_first_laser("range.intensity")};
  EXPECT_TRUE(reject_insignificant(alike, outcome(0, 0.003, 0.003), built_in_terms(), 1e-3));
  std::vector<Hypothesis> opposed = {of_first_laser("range.intensity")};
  EXPECT_FALSE(reject_insignificant(opposed, outcome(0, 0.001, -0.001), built_in_terms(), 1e-3))
      << "they are correlated";
}

TEST(Significance, TakesTheScoreTestWhereParametersAreHeld) {
  const auto verdict = [](double held, double p_value) {
    Outcome fit = outcome(0, held, 0.001);
    fit.free.erase(fit.free.begin() + 2);  // of range.intensity, b alone was estimated
    fit.covariance = 1e-6 * Eigen::MatrixXd::Identity(3, 3);
    std::vector<Hypothesis> found = {of_first_laser("range.intensity")};
    found[0].test.p_value = p_value;
    reject_insignificant(found, fit, built_in_terms(), 1e-3);
    return found[0];
  };
  EXPECT_TRUE(verdict(0.02, 1e-9).accepted) << "a is held at 20 mm: b of one standard error decides nothing";
  EXPECT_FALSE(verdict(0.02, 0.01).accepted);
  EXPECT_EQ(verdict(0.02, 1e-9).tests.back().name, "score test");
  EXPECT_FALSE(verdict(0, 1e-9).accepted) << "a is held at zero, so b is all there is";
}

TEST(Significance, HoldsTheFormOfATerm) {
  // A short recording hardly determines the time constant: c and T are known together to a tenth of c alone.
  const auto p_is_small = [](double c) {
    Calibration calibration = nominal_calibration(default_rig());
    TermParameters term = neutral_parameters(built_in_terms().get("range.warmup")->info());
    term.parameters[0].value = c;
    calibration.lasers[0].terms.push_back(term);
    Outcome outcome{.model = SensorModel(calibration, built_in_terms()),
                    .free = {},
                    .covariance = {},
                    .unobservable = {}};
    outcome.free = {outcome.model.index("laser1.range.warmup.c"),
                    outcome.model.index("laser1.range.warmup.T")};
    const double of_c = 10e-3;
    const double of_t = 50;
    outcome.covariance = Eigen::Vector2d(of_c * of_c, of_t * of_t).asDiagonal();
    outcome.covariance(0, 1) = outcome.covariance(1, 0) = std::sqrt(0.99) * of_c * of_t;
    std::vector<Hypothesis> found = {of_first_laser("range.warmup")};
    return !reject_insignificant(found, outcome, built_in_terms(), 1e-3);
  };
  EXPECT_TRUE(p_is_small(4e-3)) << "0.4 standard errors of c, and four where T is held";
  EXPECT_FALSE(p_is_small(3e-3)) << "three, and T counts as a parameter";
}

}  // namespace
}  // namespace crisp
