// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/simulate/noise.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include <crisp/error.hpp>

#include "tests/support/moments.hpp"

namespace crisp {
namespace {

using namespace crisp::model;
using namespace crisp::simulate;

constexpr RangeSettings kPlain{.sigma = 0.012, .quantum = 0};
using test::kDraws;
using test::Moments;

/// Moments of the errors of one kind of echo, of beams 0 to 9 in turn.
Moments errors_at(const NoiseEffects& effects, const EchoConditions& echo) {
  RangeNoise noise(kPlain, effects, 1, "laser1");
  std::uint16_t beam = 0;
  return test::moments([&] {
    beam = static_cast<std::uint16_t>((beam + 1) % 10);
    return noise.reported(echo, noise.draw(beam)) - echo.range;
  });
}

/// A variance of n draws scatters by √((kurtosis − 1) / n).
void expect_variance(const Moments& m, double variance) {
  EXPECT_NEAR(m.variance / variance, 1, 4 * std::sqrt((m.kurtosis - 1) / kDraws));
  EXPECT_NEAR(m.mean, 0, 4 * std::sqrt(variance / kDraws));
}

TEST(RangeNoise, IsNormalWithoutEffects) {
  const Moments m = errors_at({}, {.range = 5});
  expect_variance(m, 0.012 * 0.012);
  EXPECT_NEAR(m.kurtosis, 3, 4 * std::sqrt(96.0 / kDraws));
}

TEST(RangeNoise, GrowsWithTheRangeByItsSlope) {
  // 12 mm and 16 mm make 20 mm.
  expect_variance(errors_at({.slope = 8e-4}, {.range = 20}), 0.020 * 0.020);
  expect_variance(errors_at({.slope = 8e-4}, {.range = 0.1}), 0.012 * 0.012);
}

TEST(RangeNoise, GrowsWithTheIncidenceByItsSpread) {
  // 12 mm, and 9 mm at 45°, 36 mm where tan β = 4, 9 √99 mm at any steeper incidence than that of cos β =
  // 0.1.
  const NoiseEffects effects{.spread = 9e-3};
  expect_variance(errors_at(effects, {.range = 5}), 0.012 * 0.012);
  expect_variance(errors_at(effects, {.range = 5, .cosine = std::sqrt(0.5)}), 0.015 * 0.015);
  expect_variance(errors_at(effects, {.range = 5, .cosine = 1 / std::sqrt(17.0)}), 144e-6 + 1296e-6);
  for (const double grazing : {0.1, 0.01, 0.0}) {
    expect_variance(errors_at(effects, {.range = 5, .cosine = grazing}), 144e-6 + 99 * 81e-6);
  }
}

TEST(RangeNoise, GrowsWithWeakEchoesByItsJitter) {
  // 12 mm, and 90 mm / √100 = 9 mm, 90 mm / √25 = 18 mm, 90 mm for one unit and less.
  const NoiseEffects effects{.jitter = 0.09};
  expect_variance(errors_at(effects, {.range = 5, .remission = 100}), 0.015 * 0.015);
  expect_variance(errors_at(effects, {.range = 5, .remission = 25}), 144e-6 + 324e-6);
  for (const double weak : {1.0, 0.3, 0.0}) {
    expect_variance(errors_at(effects, {.range = 5, .remission = weak}), 144e-6 + 8100e-6);
  }
}

TEST(RangeNoise, AddsTheVariancesOfAllItsParts) {
  // (12 mm)² + (0.8 mm · 20)² + (9 mm · 1)² + (90 mm)² / 100 = 144 + 256 + 81 + 81 mm²
  expect_variance(errors_at({.slope = 8e-4, .spread = 9e-3, .jitter = 0.09},
                            {.range = 20, .cosine = std::sqrt(0.5), .remission = 100}),
                  562e-6);
}

TEST(RangeNoise, HasTheVarianceAndTheKurtosisOfAMixture) {
  // 10 % of 3 times the spread: variance 0.9 + 0.1 · 9 = 1.8, fourth moment 3 (0.9 + 0.1 · 81) = 27.
  const Moments m = errors_at({.tail_share = 0.1, .tail_scale = 3}, {.range = 5});
  expect_variance(m, 1.8 * 0.012 * 0.012);
  EXPECT_NEAR(m.kurtosis, 27 / (1.8 * 1.8), 0.3);
}

TEST(RangeNoise, HasTwoPeaksWhoseWeightsAreTheBeamsOwn) {
  const NoiseEffects effects{.separation = 0.015, .least_weight = 0.2, .most_weight = 0.9};
  const RangeSettings quiet{.sigma = 0, .quantum = 0};
  RangeNoise noise(quiet, effects, 1, "laser1");
  double least = 1, most = 0;
  for (std::uint16_t beam = 0; beam < 4; ++beam) {
    int far = 0;
    constexpr int kShots = 10'000;
    for (int i = 0; i < kShots; ++i) {
      const double error = noise.reported({.range = 5}, noise.draw(beam)) - 5;
      EXPECT_NEAR(std::abs(error), 0.0075, 1e-12);
      far += error > 0 ? 1 : 0;
    }
    least = std::min(least, far / double{kShots});
    most = std::max(most, far / double{kShots});
  }
  EXPECT_GT(least, 0.18);
  EXPECT_LT(most, 0.92);
  EXPECT_GT(most - least, 0.05) << "four draws between 0.2 and 0.9, seed 1";
}

TEST(RangeNoise, IsRoundedToTheStepOfTheLaserOrOfAll) {
  RangeNoise coarse({.sigma = 0.012, .quantum = 0.001}, {.step = 0.01}, 1, "laser1");
  RangeNoise fine({.sigma = 0.012, .quantum = 0.001}, {}, 1, "laser1");
  for (int i = 0; i < 100; ++i) {
    const double centimetres = coarse.reported({.range = 5}, coarse.draw(0)) * 100;
    const double millimetres = fine.reported({.range = 5}, fine.draw(0)) * 1000;
    EXPECT_NEAR(centimetres, std::round(centimetres), 1e-9);
    EXPECT_NEAR(millimetres, std::round(millimetres), 1e-9);
  }
}

TEST(RangeNoise, RefusesWhatMakesNoSense) {
  const auto make = [](const NoiseEffects& effects) { return RangeNoise(kPlain, effects, 1, "laser1"); };
  EXPECT_THROW(make({.slope = -1}), Error);
  EXPECT_THROW(make({.spread = -1}), Error);
  EXPECT_THROW(make({.jitter = -1}), Error);
  EXPECT_THROW(make({.tail_share = 1.1}), Error);
  EXPECT_THROW(make({.separation = 0.01, .least_weight = 0.9, .most_weight = 0.2}), Error);
  EXPECT_THROW(RangeNoise({.sigma = -1}, {}, 1, "laser1"), Error);
}

}  // namespace
}  // namespace crisp
