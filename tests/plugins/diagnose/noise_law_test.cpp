// SPDX-License-Identifier: BSD-3-Clause
// What the variance of ranges is the sum of is told from the ranges, each part for itself.
#include "plugins/diagnose/noise_law.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <functional>
#include <random>

#include "plugins/diagnose/noise.hpp"
#include "plugins/diagnose/non_negative.hpp"

namespace crisp {
namespace {

using testing::DoubleNear;
using testing::ElementsAre;
using testing::IsEmpty;

constexpr std::size_t kRanges = 20'000;

/// The parts' variances by hand.
double variance_of(const ByPart& size, double range, double cosine, double remission) {
  const double tangent = std::sqrt(1 - cosine * cosine) / cosine;
  return std::pow(size[0], 2) + std::pow(size[1] * range, 2) + std::pow(size[2] * tangent, 2) +
         std::pow(size[3], 2) / remission;
}

/// Ranges from 1 to 20 m, met at up to 60°, that come back as from surfaces of many reflectances: where it is
/// far or steep echoes are weak.
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

/// By how many of its standard errors the value of a cause is off; infinite if it was not found.
double off(const NoiseDiagnosis& found, const std::string& cause, double truth) {
  const auto finding = std::ranges::find(found.findings, cause, &Finding::cause);
  if (finding == found.findings.end()) return HUGE_VAL;
  const Parameter& parameter = finding->parameters.at(0);
  return (parameter.value - truth) / parameter.std_error;
}

TEST(NonNegative, RegressionIsTheUsualOneWhereNothingIsNegative) {
  NonNegativeProblem problem(3);  // 2 + 3 x, and a lever that is never pulled
  for (const double x : {0.0, 1.0, 2.0, 5.0}) problem.add(std::vector{1.0, x, 0.0}, 2 + 3 * x, 1 / (1 + x));
  EXPECT_THAT(problem.solution(), ElementsAre(DoubleNear(2, 1e-9), DoubleNear(3, 1e-9), 0));
}

TEST(NonNegative, RegressionLeavesOutWhatWouldBeNegative) {
  NonNegativeProblem problem(2);  // 2 - x by hand: the mean of 2, 1, 0, weighted alike
  for (const double x : {0.0, 1.0, 2.0}) problem.add(std::vector{1.0, x}, 2 - x, 1);
  EXPECT_THAT(problem.solution(), ElementsAre(DoubleNear(1, 1e-12), 0));
}

TEST(NonNegative, RegressionOnLeversThatAreAlikeTakesOneOfThem) {
  NonNegativeProblem problem(2);
  for (int i = 0; i < 3; ++i) problem.add(std::vector{1.0, 4.0}, 8, 1);
  const auto found = problem.solution();
  EXPECT_NEAR(found[0] + 4 * found[1], 8, 1e-9);
  EXPECT_EQ(found[0] * found[1], 0);
}

TEST(NoiseLaw, HasTheVariancesOfItsPartsAddedUp) {
  // (3 mm)² + (0.5 mm · 8)² + (6 mm · 1)² + (100 mm)² / 25 = 9 + 16 + 36 + 400 mm²
  const NoiseLaw law{.size = {3e-3, 5e-4, 6e-3, 0.1}, .parts = {true, true, true, true}};
  const EchoConditions echo{.range = 8, .cosine = std::sqrt(0.5), .remission = 25};
  EXPECT_NEAR(law.variance(echo, 0), 461e-6, 1e-12);
  EXPECT_NEAR(law.log_density(0, echo, 0), -std::log(std::sqrt(2 * M_PI * 461e-6)), 1e-9);
}

TEST(NoiseLaw, StaysFiniteWhereBeamsGrazeAndNothingComesBack) {
  const NoiseLaw law{.size = {3e-3, 0, 6e-3, 0.1}, .parts = {true, false, true, true}};
  // tan β = √99 at most, and one unit of remission at least
  EXPECT_NEAR(law.variance({.range = 8, .cosine = 0, .remission = 0}, 0), 9e-6 + 99 * 36e-6 + 0.01, 1e-12);
}

TEST(NoiseLaw, OfAllPartsAtOnceIsFoundWithTheSizeOfEach) {
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
    // A σ of 60 000 ranges is known to 6 mm / √120 000 = 0.02 mm by itself, to ten times that beside three
    // others.
    EXPECT_NEAR(found.law.sigma(), truth[0], 6e-4) << seed;
  }
}

TEST(NoiseLaw, OfOnePartIsNotTakenForAnother) {
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
      EXPECT_GT(found.findings[0].log10_odds, 2) << cause << ", seed " << seed;
      EXPECT_THAT(found.findings[0].confounded_with, IsEmpty());
    }
  }
}

TEST(NoiseLaw, OfPlainNoiseIsPlainWhateverIsKnownOfTheEchoes) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const auto found = diagnose_noise("laser1", drawn(seed, {0.012, 0, 0, 0}), seed);
    EXPECT_THAT(found.findings, IsEmpty()) << seed;
    EXPECT_THAT(found.unnamed, IsEmpty()) << seed;
  }
}

TEST(NoiseLaw, IsNotTriedOverWhatIsMissingOrAlwaysTheSame) {
  RangeErrors errors = drawn(1, {8e-3, 0, 6e-3, 0.05});
  errors.cosine.clear();
  errors.remission.assign(kRanges, 0);
  for (const auto& cause : causes_in(diagnose_noise("laser1", errors, 1))) {
    EXPECT_NE(cause, "noise.incidence_dependent");
    EXPECT_NE(cause, "noise.remission_dependent");
  }
}

}  // namespace
}  // namespace crisp
