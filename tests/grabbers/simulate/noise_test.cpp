// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/simulate/noise.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "pipeline/data/error.hpp"
#include "tests/grabbers/simulate/moments.hpp"

namespace crisp {
namespace {

constexpr RangeSettings kPlain{.sigma = 0.012, .quantum = 0};
using test::kDraws;
using test::Moments;

/// Of the errors at one range, of beams 0 to 9 in turn.
Moments errors_at(const NoiseEffects& effects, double range, const RangeSettings& settings = kPlain) {
  RangeNoise noise(settings, effects, 10, 1, "laser1");
  std::uint16_t beam = 0;
  return test::moments([&] {
    beam = static_cast<std::uint16_t>((beam + 1) % 10);
    return noise.reported(range, noise.draw(beam)) - range;
  });
}

/// A variance of n draws scatters by √((kurtosis − 1) / n).
void expect_variance(const Moments& m, double variance) {
  EXPECT_NEAR(m.variance / variance, 1, 4 * std::sqrt((m.kurtosis - 1) / kDraws));
  EXPECT_NEAR(m.mean, 0, 4 * std::sqrt(variance / kDraws));
}

TEST(RangeNoise, IsNormalWithoutEffects) {
  const Moments m = errors_at({}, 5);
  expect_variance(m, 0.012 * 0.012);
  EXPECT_NEAR(m.kurtosis, 3, 4 * std::sqrt(96.0 / kDraws));
}

TEST(RangeNoise, GrowsWithTheRangeByItsSlope) {
  // 12 mm and 16 mm make 20 mm.
  expect_variance(errors_at({.slope = 8e-4}, 20), 0.020 * 0.020);
  expect_variance(errors_at({.slope = 8e-4}, 0.1), 0.012 * 0.012);
}

TEST(RangeNoise, HasTheVarianceAndTheKurtosisOfAMixture) {
  // 10 % of 3 times the spread: variance 0.9 + 0.1 · 9 = 1.8, fourth moment 3 (0.9 + 0.1 · 81) = 27.
  const Moments m = errors_at({.tail_share = 0.1, .tail_scale = 3}, 5);
  expect_variance(m, 1.8 * 0.012 * 0.012);
  EXPECT_NEAR(m.kurtosis, 27 / (1.8 * 1.8), 0.3);
}

TEST(RangeNoise, HasTwoPeaksWhoseWeightsAreTheBeamsOwn) {
  const NoiseEffects effects{.separation = 0.015, .least_weight = 0.2, .most_weight = 0.9};
  const RangeSettings quiet{.sigma = 0, .quantum = 0};
  RangeNoise noise(quiet, effects, 4, 1, "laser1");
  double least = 1, most = 0;
  for (std::uint16_t beam = 0; beam < 4; ++beam) {
    int far = 0;
    constexpr int kShots = 10'000;
    for (int i = 0; i < kShots; ++i) {
      const double error = noise.reported(5, noise.draw(beam)) - 5;
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
  RangeNoise coarse({.sigma = 0.012, .quantum = 0.001}, {.step = 0.01}, 1, 1, "laser1");
  RangeNoise fine({.sigma = 0.012, .quantum = 0.001}, {}, 1, 1, "laser1");
  for (int i = 0; i < 100; ++i) {
    const double centimetres = coarse.reported(5, coarse.draw(0)) * 100;
    const double millimetres = fine.reported(5, fine.draw(0)) * 1000;
    EXPECT_NEAR(centimetres, std::round(centimetres), 1e-9);
    EXPECT_NEAR(millimetres, std::round(millimetres), 1e-9);
  }
}

TEST(RangeNoise, RefusesWhatMakesNoSense) {
  const auto make = [](const NoiseEffects& effects) { return RangeNoise(kPlain, effects, 1, 1, "laser1"); };
  EXPECT_THROW(make({.slope = -1}), Error);
  EXPECT_THROW(make({.tail_share = 1.1}), Error);
  EXPECT_THROW(make({.separation = 0.01, .least_weight = 0.9, .most_weight = 0.2}), Error);
  EXPECT_THROW(RangeNoise({.sigma = -1}, {}, 1, 1, "laser1"), Error);
}

}  // namespace
}  // namespace crisp
