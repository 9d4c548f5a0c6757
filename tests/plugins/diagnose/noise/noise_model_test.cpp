// SPDX-License-Identifier: BSD-3-Clause
// The parts of the variance are estimated from ranges, each by itself.
#include "plugins/diagnose/noise/noise_model.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <functional>
#include <random>

#include "pipeline/statistics/non_negative_regression.hpp"
#include "plugins/diagnose/noise/expectation_step.hpp"
#include "plugins/diagnose/noise/noise_diagnosis.hpp"

namespace crisp {
namespace {

using namespace crisp::diagnose;
using namespace crisp::model;
using namespace crisp::statistics;
using testing::DoubleNear;
using testing::ElementsAre;
using testing::IsEmpty;

constexpr std::size_t kRanges = 20'000;

/// Sum of the parts' variances, independent of the code under test.
double variance_of(const ByPart& size, double range, double cosine, double remission) {
  const double tangent = std::sqrt(1 - cosine * cosine) / cosine;
  return std::pow(size[0], 2) + std::pow(size[1] * range, 2) + std::pow(size[2] * tangent, 2) +
         std::pow(size[3], 2) / remission;
}

/// Ranges from 1 to 20 m at up to 60° incidence, on surfaces of many reflectances: remission falls with range
/// and incidence.
RangeErrors drawn(std::uint64_t seed, const ByPart& size) {
  std::mt19937_64 random(seed);
  std::normal_distribution<> normal;
  const auto between = [&](double from, double to) {
    return std::uniform_real_distribution<>(from, to)(random);
  };
  RangeErrors errors;
  for (std::size_t i = 0; i < kRanges; ++i) {
    const double range = between(1, 20);
    const double cosine = between(0.5, 1);
    const double remission = std::ceil(254 * between(0.1, 0.9) * cosine / (1 + range * range / 100));
    errors.range.push_back(static_cast<float>(range));
    errors.cosine.push_back(static_cast<float>(cosine));
    errors.remission.push_back(static_cast<float>(remission));
    errors.value.push_back(
        static_cast<float>(std::sqrt(variance_of(size, range, cosine, remission)) * normal(random)));
    errors.beam.push_back(static_cast<std::uint16_t>(i % 50));
    errors.block.push_back(static_cast<std::uint32_t>(i / 500));
  }
  return errors;
}

std::vector<std::string> causes_in(const NoiseDiagnosis& found) {
  std::vector<std::string> causes;
  for (const Finding& finding : found.findings) causes.push_back(finding.cause);
  return causes;
}

/// Error of a cause's estimate in units of its standard error; infinite if it was not found.
double off(const NoiseDiagnosis& found, const std::string& cause, double truth) {
  const auto finding = std::ranges::find(found.findings, cause, &Finding::cause);
  if (finding == found.findings.end()) return HUGE_VAL;
  const Parameter& parameter = finding->parameters.at(0);
  return (parameter.value - truth) / parameter.std_error;
}

TEST(NonNegativeProblem, IsOrdinaryLeastSquaresIfNothingIsNegative) {
  NonNegativeProblem problem(3);  // 2 + 3 x, and a regressor that is always 0
  for (const double x : {0.0, 1.0, 2.0, 5.0}) problem.add(std::vector{1.0, x, 0.0}, 2 + 3 * x, 1 / (1 + x));
  EXPECT_THAT(problem.solution(), ElementsAre(DoubleNear(2, 1e-9), DoubleNear(3, 1e-9), 0));
}

TEST(NonNegativeProblem, LeavesOutNegativeCoefficients) {
  NonNegativeProblem problem(2);  // 2 - x worked out: the mean of 2, 1, 0 of equal weights
  for (const double x : {0.0, 1.0, 2.0}) problem.add(std::vector{1.0, x}, 2 - x, 1);
  EXPECT_THAT(problem.solution(), ElementsAre(DoubleNear(1, 1e-12), 0));
}

TEST(NonNegativeProblem, KeepsOneOfCollinearRegressors) {
  NonNegativeProblem problem(2);
  for (int i = 0; i < 3; ++i) problem.add(std::vector{1.0, 4.0}, 8, 1);
  const auto found = problem.solution();
  EXPECT_NEAR(found[0] + 4 * found[1], 8, 1e-9);
  EXPECT_EQ(found[0] * found[1], 0);
}

TEST(NoiseModel, AddsTheVariancesOfItsParts) {
  // (3 mm)² + (0.5 mm · 8)² + (6 mm · 1)² + (100 mm)² / 25 = 9 + 16 + 36 + 400 mm²
  const NoiseModel model{.size = {3e-3, 5e-4, 6e-3, 0.1}, .parts = {true, true, true, true}};
  const EchoConditions echo{.range = 8, .cosine = std::sqrt(0.5), .remission = 25};
  EXPECT_NEAR(model.variance(echo, 0), 461e-6, 1e-12);
  EXPECT_NEAR(model.log_density(0, echo, 0), -std::log(std::sqrt(2 * M_PI * 461e-6)), 1e-9);
}

TEST(NoiseModel, StaysFiniteAtGrazingIncidenceWithoutRemission) {
  const NoiseModel model{.size = {3e-3, 0, 6e-3, 0.1}, .parts = {true, false, true, true}};
  // tan β = √99 at most, and one unit of remission at least
  EXPECT_NEAR(model.variance({.range = 8, .cosine = 0, .remission = 0}, 0), 9e-6 + 99 * 36e-6 + 0.01, 1e-12);
}

TEST(NoiseModel, OfAllPartsIsEstimatedWithinItsErrors) {
  const ByPart truth = {6e-3, 6e-4, 6e-3, 0.06};
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    const auto found = diagnose_noise("laser1", drawn(seed, truth), seed);
    EXPECT_THAT(causes_in(found),
                testing::UnorderedElementsAre("noise.range_dependent", "noise.incidence_dependent",
                                              "noise.remission_dependent"))
        << seed;
    EXPECT_LT(std::abs(off(found, "noise.range_dependent", truth[1])), 4) << seed;
    EXPECT_LT(std::abs(off(found, "noise.incidence_dependent", truth[2])), 4) << seed;
    EXPECT_LT(std::abs(off(found, "noise.remission_dependent", truth[3])), 4) << seed;
    // The standard error of σ from 60 000 ranges is 6 mm / √120 000 = 0.02 mm alone, and ten times that
    // jointly with three other parts.
    EXPECT_NEAR(found.model.sigma(), truth[0], 6e-4) << seed;
  }
}

TEST(NoiseModel, OfOnePartIsNotTakenForAnother) {
  const std::vector<std::pair<std::string, ByPart>> hidden = {
      {"noise.range_dependent", {8e-3, 1e-3, 0, 0}},
      {"noise.incidence_dependent", {8e-3, 0, 6e-3, 0}},
      {"noise.remission_dependent", {8e-3, 0, 0, 0.05}}};
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    for (const auto& [cause, size] : hidden) {
      const auto found = diagnose_noise("laser1", drawn(seed, size), seed);
      ASSERT_THAT(causes_in(found), ElementsAre(cause)) << seed;
      const auto truth = *std::ranges::max_element(size.begin() + 1, size.end());
      EXPECT_LT(std::abs(off(found, cause, truth)), 4) << cause << ", seed " << seed;
      EXPECT_GT(found.findings[0].log10_bayes_factor, 2) << cause << ", seed " << seed;
      EXPECT_THAT(found.findings[0].confounded_with, IsEmpty());
    }
  }
}

TEST(NoiseModel, OfPlainNoiseIsPlainForAnyCovariates) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const auto found = diagnose_noise("laser1", drawn(seed, {0.012, 0, 0, 0}), seed);
    EXPECT_THAT(found.findings, IsEmpty()) << seed;
    EXPECT_THAT(found.unnamed, IsEmpty()) << seed;
  }
}

TEST(NoiseModel, IsNotTriedOverMissingOrConstantCovariates) {
  RangeErrors errors = drawn(1, {8e-3, 0, 6e-3, 0.05});
  errors.cosine.clear();
  errors.remission.assign(kRanges, 0);
  for (const auto& cause : causes_in(diagnose_noise("laser1", errors, 1))) {
    EXPECT_NE(cause, "noise.incidence_dependent");
    EXPECT_NE(cause, "noise.remission_dependent");
  }
}

TEST(ExpectationStep, GivesTheDensityOfEachRangeByItself) {
  RangeErrors errors = drawn(4, {0.01, 0.001, 0.004, 0.05});
  errors.value[3] = 40;  // all components underflow
  NoiseModel model{.size = {0.008, 0.002, 0.003, 0.04},
                   .tail_share = 0.1,
                   .tail_scale = 6,
                   .separation = 0.02,
                   .weight = std::vector<double>(50, 0.3),
                   .relative = std::vector<double>(50, 1.2),
                   .parts = {true, true, true, true},
                   .has_tail = true};
  model.weight[7] = 0.9;
  model.relative[8] = 0.5;
  NoiseModel with_tail = model;
  with_tail.weight.clear();
  NoiseModel plain;
  const ExpectationStep step(errors);
  for (const NoiseModel& each : {model, with_tail, plain}) {
    const auto densities = step.log_densities(each);
    const ExpectationSums sums = step.sums(each, 50);
    ASSERT_EQ(densities.size(), errors.size());
    double all = 0;
    for (std::size_t i = 0; i < errors.size(); ++i) {
      const double expected = each.log_density(double{errors.value[i]}, errors.echo(i), errors.beam[i]);
      ASSERT_NEAR(densities[i], expected, 1e-9 * std::abs(expected) + 1e-12) << i;
      all += expected;
    }
    EXPECT_NEAR(sums.log_likelihood, all, 1e-9 * std::abs(all));
    EXPECT_EQ(sums.ranges, kRanges);
  }
}

TEST(ExpectationStep, IsNotNeededForANormalDistribution) {
  const RangeErrors errors = drawn(5, {0.01, 0, 0, 0});
  double squares = 0;
  for (const float value : errors.value) squares += double{value} * double{value};
  EXPECT_NEAR(fitted({}, errors).sigma(), std::sqrt(squares / kRanges), 1e-15);
  EXPECT_EQ(fitted({}, {}).sigma(), 1e-5) << "the minimum without ranges";
}

}  // namespace
}  // namespace crisp
