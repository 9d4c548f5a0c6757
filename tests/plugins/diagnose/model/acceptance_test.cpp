// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/diagnose/model/acceptance.hpp"

#include <gtest/gtest.h>

#include "tests/support/built_in_terms.hpp"

namespace crisp {
namespace {

using namespace crisp::diagnose;
using namespace crisp::estimate;

Refinement fit_of(const Calibration& start) {
  Refinement fit{
      .outcome = {
          .model = SensorModel(start, built_in_terms()), .free = {}, .covariance = {}, .unobservable = {}}};
  const auto& names = fit.outcome.model.names();
  for (std::size_t k = 0; k < names.size(); ++k) {
    if (names[k].ends_with("range.offset.c")) fit.outcome.free.push_back(k);
  }
  const auto n = static_cast<Eigen::Index>(fit.outcome.free.size());
  fit.outcome.covariance = 1e-10 * Eigen::MatrixXd::Identity(n, n);
  return fit;
}

std::size_t terms_of(const Calibration& calibration) {
  std::size_t terms = 0;
  for (const LaserCalibration& laser : calibration.lasers) terms += laser.terms.size();
  return terms;
}

/// Two lasers with offsets of a millimetre, which hardly shows.
Diagnosis two_small_offsets() {
  Diagnosis diagnosis{.before = fit_of(nominal_calibration(default_rig())),
                      .after = fit_of(nominal_calibration(default_rig()))};
  Calibration extended = nominal_calibration(default_rig());
  for (const std::size_t laser : {0, 1}) {
    Hypothesis one;
    one.candidate.owner = laser;
    one.candidate.name = "laser" + std::to_string(laser + 1) + ".range.offset";
    one.candidate.family = "range.offset";
    one.candidate.term = neutral_parameters(built_in_terms().get("range.offset")->info());
    one.candidate.term.parameters[0].value = 1e-3;
    one.test.visible = 0.03;
    extended.lasers[laser].terms.push_back(one.candidate.term);
    diagnosis.hypotheses.push_back(one);
  }
  diagnosis.after = fit_of(extended);
  return diagnosis;
}

/// @param p_value_with  that the residuals are noise, once the model has both terms; without, it is none
Diagnosis judged(double p_value_with) {
  Diagnosis diagnosis = two_small_offsets();
  const auto score = [](const Calibration& calibration) {
    CrossValidator::Score score;
    for (int piece = 0; piece < 4; ++piece)
      score.pieces.push_back({.weight = 1, .likelihood = static_cast<double>(terms_of(calibration))});
    return score;
  };
  const AcceptanceFits fits{.held_out = score, .refit = fit_of, .compare = [&](const Refinement& fit) {
                              const bool has_both = terms_of(fit.outcome.model.calibration()) == 2;
                              return ProfileComparison{.p_value = has_both ? p_value_with : 1e-40};
                            }};
  accept_or_reject(diagnosis, score(nominal_calibration(default_rig())), fits, built_in_terms(), {});
  return diagnosis;
}

TEST(Acceptance, RejectsASmallCommonEffectThatLeavesMore) {
  const Diagnosis diagnosis = judged(1e-20);
  for (const Hypothesis& one : diagnosis.hypotheses) EXPECT_FALSE(one.accepted);
  EXPECT_EQ(terms_of(diagnosis.after.outcome.model.calibration()), 0U);
}

TEST(Acceptance, KeepsASmallCommonEffectThatExplainsAll) {
  const Diagnosis diagnosis = judged(0.5);
  for (const Hypothesis& one : diagnosis.hypotheses) {
    EXPECT_TRUE(one.accepted);
    EXPECT_EQ(one.tests.back().name, "goodness of fit with it");
    EXPECT_EQ(one.tests.back().p_value, 0.5);
  }
  EXPECT_EQ(terms_of(diagnosis.after.outcome.model.calibration()), 2U);
}

}  // namespace
}  // namespace crisp
