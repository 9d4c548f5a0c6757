// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/estimate/surfel_refinement.hpp"

#include <gmock/gmock.h>

#include <Eigen/LU>

#include <crisp/error.hpp>

#include "tests/pipeline/estimate/support.hpp"

namespace crisp {
namespace {

using namespace crisp::data;
using namespace crisp::estimate;
using namespace crisp::simulate;

SensorModel off_by(const Calibration& truth, double metres, double radians, double seconds) {
  SensorModel model(truth);
  Eigen::VectorXd values = model.values();
  for (const auto tau : {1, 5, 9}) values[tau] += tau == 5 ? -metres : metres;
  for (const auto angle : {2, 4, 6, 8, 10}) values[angle] += angle % 4 == 2 ? radians : -radians;
  for (const auto eta : {3, 7, 11}) values[eta] += eta == 7 ? -seconds : seconds;
  model.set_values(values);
  return model;
}

class SurfelRefinement : public testing::TestWithParam<int> {};

TEST_P(SurfelRefinement, FindsTheTruthWithinItsStandardErrors) {
  const auto recording =
      simulate_measurements(misplaced_scanner(static_cast<std::uint64_t>(GetParam()), 4.0), office());
  const SensorModel truth(recording.truth);
  const Refinement refined =
      refine_by_surfels(off_by(recording.truth, 0.008, 0.01, 0.0005), sample_of(recording), {});
  EXPECT_TRUE(refined.converged);
  EXPECT_TRUE(refined.outcome.unobservable.empty());
  const auto& free = refined.outcome.free;
  ASSERT_EQ(free.size(), 11U);
  const Eigen::VectorXd error = picked(refined.outcome.model, free) - picked(truth, free);
  // In all: χ² with 11 degrees of freedom is below 40 in all but one case of 30 000.
  const double chi2 = error.dot(refined.outcome.covariance.inverse() * error);
  EXPECT_LT(chi2, 40);
  // The data's resolution: a tenth of a millimetre or two.
  for (const Eigen::Index tau : {0, 4, 8}) EXPECT_LT(std::abs(error[tau]), 0.001);
}

INSTANTIATE_TEST_SUITE_P(Seeds, SurfelRefinement, testing::Values(1, 2, 3));

TEST(SurfelRefinement, KeepsEtasWithinTheLimitsOfThePrior) {
  const auto recording = simulate_measurements(misplaced_scanner(1, 4.0), office());
  const SensorModel truth(recording.truth);
  RefinementSettings settings;
  settings.prior.latest_eta = truth.values()({3, 7, 11}).maxCoeff() - 0.002;
  const Refinement refined =
      refine_by_surfels(off_by(recording.truth, 0.008, 0.01, -0.004), sample_of(recording), settings);
  for (const auto eta : {3, 7, 11}) EXPECT_LE(refined.outcome.model.values()[eta], settings.prior.latest_eta);
}

TEST(SurfelRefinement, HoldsParametersThatAConstantSpeedDoesNotDetermine) {
  auto scanner = misplaced_scanner(1, 3.0);
  scanner.motion = {.kind = MotionKind::constant, .max_rate = 0.91};  // no whole number of scans a turn
  const auto recording = simulate_measurements(scanner, office());
  const Refinement refined =
      refine_by_surfels(off_by(recording.truth, 0.004, 0.004, 0), sample_of(recording), {});
  ASSERT_EQ(refined.outcome.unobservable.size(), 5U);  // and both azimuths, which hang on the lags
  for (const auto& lost : refined.outcome.unobservable) {
    if (lost.parameter.ends_with(".lambda")) continue;
    EXPECT_THAT(lost.parameter, testing::EndsWith(".eta"));
    const auto slot = static_cast<Eigen::Index>(refined.outcome.model.index(lost.parameter));
    EXPECT_EQ(refined.outcome.model.values()[slot], SensorModel(recording.truth).values()[slot]);
  }
  const auto& free = refined.outcome.free;
  const Eigen::VectorXd error =
      picked(refined.outcome.model, free) - picked(SensorModel(recording.truth), free);
  EXPECT_LT(error.dot(refined.outcome.covariance.inverse() * error), 40);
}

TEST(SurfelRefinement, MarksOneLasersSingleSweepUntrusted) {
  const auto recording = simulate_measurements(misplaced_scanner(1, 4.0), office());
  const Calibration only = {.lasers = {recording.truth.lasers[0]}};
  const Sample own = of_laser(sample_of(recording), 0);
  const auto caveats_up_to = [&](double angle) {
    const double first = own.plate->at(own.beams.time.front())->angle;
    const Sample part =
        select(own, [&](std::size_t i) { return own.plate->at(own.beams.time[i])->angle < first + angle; });
    return refine_by_surfels(SensorModel(only), part, {}).outcome.caveats;
  };
  EXPECT_THAT(caveats_up_to(1.5), testing::Contains(testing::HasSubstr("sees no surface twice")));
  EXPECT_THAT(caveats_up_to(6.5),
              testing::Not(testing::Contains(testing::HasSubstr("sees no surface twice"))));
}

TEST(SurfelRefinement, TakesTheRigsValuesAsObservations) {
  const auto recording = simulate_measurements(misplaced_scanner(1, 2.0), office());
  const SensorModel start = off_by(recording.truth, 0.002, 0.002, 0);
  const auto laser2_tau = [&](double value, double std_error) {
    RefinementSettings settings;
    if (std_error > 0) settings.prior.nominal["laser2.tau"] = {.value = value, .std_error = std_error};
    const auto& outcome = refine_by_surfels(start, sample_of(recording), settings).outcome;
    return std::pair(outcome.model.values()[5], std::sqrt(outcome.covariance(4, 4)));
  };
  const auto [alone, error] = laser2_tau(0, 0);
  const double elsewhere = alone + 0.01;
  // Two observations of one value, weighted by their variances.
  const double near = alone + 2 * error;
  const auto [mean, mean_error] = laser2_tau(near, error);
  EXPECT_NEAR(mean, (alone + near) / 2, 0.3 * error);
  EXPECT_NEAR(mean_error, error / std::numbers::sqrt2, 0.2 * error);
  EXPECT_NEAR(laser2_tau(elsewhere, 1e3 * error).first, alone, 0.1 * error);
  EXPECT_NEAR(laser2_tau(elsewhere, 1e-3 * error).first, elsewhere, 0.1 * error);
}

TEST(SurfelRefinement, CountsWhatFixedParametersMayBeOffBy) {
  const auto recording = simulate_measurements(misplaced_scanner(1, 2.0), office());
  const SensorModel truth(recording.truth);
  constexpr double kOff = 1 * kDegree;
  const SensorModel start =
      with_one(truth, truth.index("laser2.alpha"),
               truth.values()[static_cast<Eigen::Index>(truth.index("laser2.alpha"))] + kOff);
  RefinementSettings settings;
  settings.fixed = {"laser2.alpha"};
  const auto refined = [&] { return refine_by_surfels(start, sample_of(recording), settings).outcome; };
  const auto conditional = testing::HasSubstr("combinations with fixed parameters only");
  EXPECT_THAT(refined().caveats,
              testing::Contains(testing::AllOf(conditional, testing::HasSubstr("laser2.alpha"))));

  settings.prior.nominal["laser2.alpha"] = {.value = 0, .std_error = kOff};
  const Outcome outcome = refined();
  EXPECT_THAT(outcome.caveats, testing::Not(testing::Contains(conditional)));
  const Eigen::VectorXd error = picked(outcome.model, outcome.free) - picked(truth, outcome.free);
  const Eigen::VectorXd errors = outcome.covariance.diagonal().cwiseSqrt();
  EXPECT_GT(error.cwiseAbs().maxCoeff(), 0.1 * kDegree) << "of laser2's lambda";
  EXPECT_LT(error.cwiseQuotient(errors).cwiseAbs().maxCoeff(), 4);
}

TEST(SurfelRefinement, WhatTheRigKnowsOfALagIsInTheStandardErrorsAtConstantSpeed) {
  auto scanner = misplaced_scanner(1, 3.0);
  scanner.motion = {.kind = MotionKind::constant, .max_rate = 0.91};
  const auto recording = simulate_measurements(scanner, office());
  RefinementSettings settings;
  for (const auto& laser : recording.truth.lasers) {
    settings.prior.nominal[laser.name + ".eta"] = {.value = laser.eta.value + 0.001, .std_error = 0.002};
  }
  const auto refined =
      refine_by_surfels(off_by(recording.truth, 0.004, 0.004, 0), sample_of(recording), settings);
  const auto& outcome = refined.outcome;
  const auto lambda2 = std::ranges::find(outcome.free, outcome.model.index("laser2.lambda"));
  ASSERT_NE(lambda2, outcome.free.end());
  const auto k = lambda2 - outcome.free.begin();
  const double rate = 2 * std::numbers::pi * 0.91;
  EXPECT_NEAR(std::sqrt(outcome.covariance(k, k)), std::numbers::sqrt2 * rate * 0.002, 0.1 * rate * 0.002);
  const auto eta = static_cast<Eigen::Index>(outcome.model.index("laser2.eta"));
  EXPECT_DOUBLE_EQ(outcome.model.values()[eta], recording.truth.lasers[1].eta.value + 0.001);
}

TEST(SurfelRefinement, AnAzimuthThatHangsOnAnUnknownLagIsNotFree) {
  auto scanner = misplaced_scanner(1, 3.0);
  scanner.motion = {.kind = MotionKind::constant, .max_rate = 0.91};
  const auto recording = simulate_measurements(scanner, office());
  const Outcome outcome =
      refine_by_surfels(off_by(recording.truth, 0.004, 0.004, 0), sample_of(recording), {}).outcome;
  for (const std::size_t lambda : {4, 8}) {
    EXPECT_EQ(std::ranges::count(outcome.free, lambda), 0) << lambda;
    const auto lost =
        std::ranges::find(outcome.unobservable, outcome.model.names()[lambda], &Unobservable::parameter);
    ASSERT_NE(lost, outcome.unobservable.end());
    EXPECT_THAT(lost->combination, testing::HasSubstr(".eta"));
  }
  EXPECT_EQ(outcome.covariance.rows(), static_cast<Eigen::Index>(outcome.free.size()));
}

TEST(SurfelRefinement, CountsBeamsAlongEdgesToo) {
  const auto recording = simulate_measurements(misplaced_scanner(1, 2.0), office());
  const Refinement refined = refine_by_surfels(SensorModel(recording.truth), sample_of(recording), {});
  // Some 2 % are on surfaces below the smallest cell; the rest ended on walls and furniture.
  EXPECT_GT(static_cast<double>(refined.beams), 0.96 * static_cast<double>(recording.beams.size()));
}

TEST(SurfelRefinement, StopsOnRequest) {
  const auto recording = simulate_measurements(misplaced_scanner(1, 1.0), office());
  int rounds = 0;
  const Refinement refined = refine_by_surfels(off_by(recording.truth, 0.008, 0.01, 0.0005),
                                               sample_of(recording), {}, [&](int) { return rounds++ < 2; });
  EXPECT_EQ(refined.rounds, 2);
}

TEST(SurfelRefinement, WithoutSurfacesIsAnError) {
  auto recording = simulate_measurements(misplaced_scanner(1, 0.2), office());
  for (std::size_t i = 0; i < recording.beams.size(); ++i) {
    recording.beams.range[i] = 1.0F + static_cast<float>((i * 7919) % 1000) * 0.02F;  // scattered in depth
  }
  EXPECT_THROW(refine_by_surfels(SensorModel(recording.truth), sample_of(recording), {}), Error);
}

}  // namespace
}  // namespace crisp
