// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <limits>
#include <numeric>

#include <crisp/error.hpp>
#include <crisp/rqe.hpp>

#include "tests/pipeline/quality/clouds.hpp"

namespace crisp {
namespace {

constexpr double kPi = 3.14159265358979323846;

Vectors two_points(double distance) { return {{5, 5 + distance}, {-2, -2}, {1, 1}}; }

// The kernel is summed in single precision: a relative error of some 1e-7 a pair.
constexpr double kRelative = 2e-6;

TEST(Rqe, IsThatOfTwoPointsWorkedByHand) {
  // σ = 0.5: 4σ² = 1, G(0) = π^-1.5, and E = (2 G(0) + 2 G(0) e^(-d²)) / 4; the cut-off leaves out e^-36.
  const auto result = rqe(two_points(1).view(), {}, {.sigma = 0.5, .cutoff = 12});
  const double energy = std::pow(kPi, -1.5) * 0.5 * (1 + std::exp(-1.0));
  EXPECT_NEAR(result.energy, energy, kRelative * energy);
  EXPECT_NEAR(result.value, -std::log(energy), kRelative);
  EXPECT_EQ(result.pairs, 1U);
  // dH/dd = 2d e^(-d²) / (1 + e^(-d²)): apart is less crisp.
  const double slope = 2 * std::exp(-1.0) / (1 + std::exp(-1.0));
  EXPECT_NEAR(result.gradient.x[1], slope, kRelative);
  EXPECT_NEAR(result.gradient.x[0], -slope, kRelative);
  EXPECT_EQ(result.gradient.y[0], 0);
}

TEST(Rqe, WeighsTwoPointsAsWorkedByHand) {
  // w = 1, 3: E / G(0) = (1 + 9 + 2 · 3 e^(-d²)) / 16
  const std::vector<double> weights{1, 3};
  const auto result = rqe(two_points(1).view(), weights, {.sigma = 0.5, .cutoff = 12});
  const double energy = std::pow(kPi, -1.5) * (10 + 6 * std::exp(-1.0)) / 16;
  EXPECT_NEAR(result.energy, energy, kRelative * energy);
  EXPECT_NEAR(result.gradient.x[1], 12 * std::exp(-1.0) / (10 + 6 * std::exp(-1.0)), kRelative);
}

TEST(Rqe, OfOnePointIsThatOfItsKernel) {
  const Vectors one{{7}, {8}, {9}};
  const auto result = rqe(one.view(), {}, {.sigma = 0.5, .cutoff = 12});
  EXPECT_NEAR(result.energy, std::pow(kPi, -1.5), kRelative * std::pow(kPi, -1.5));
  EXPECT_EQ(result.pairs, 0U);
  EXPECT_EQ(result.gradient.x[0], 0);
}

TEST(Rqe, OfManyEqualPointsIsThatOfOne) {
  Vectors cloud;
  for (int i = 0; i < 300; ++i) test::add(cloud, 1e6, -3, 0.1);
  const auto result = rqe(cloud.view(), {}, {.sigma = 0.5, .cutoff = 12});
  EXPECT_NEAR(result.energy, std::pow(kPi, -1.5), kRelative * std::pow(kPi, -1.5));
  EXPECT_EQ(result.pairs, 300U * 299 / 2);
  EXPECT_EQ(result.gradient.y[17], 0);
}

TEST(Rqe, TruncationErrsByNoMoreThanItsBound) {
  for (const double cutoff : {2.0, 4.0, 6.0}) {
    for (const auto& cloud : {test::random_cube(700, 2, 1), test::room_corner(700, 2, 0.01, 2)}) {
      const auto weights = test::random_weights(cloud.size(), 3);
      const double truth = -std::log(test::energy_of_all_pairs(cloud, weights, 0.1));
      const auto result = rqe(cloud.view(), weights, {.sigma = 0.1, .cutoff = cutoff});
      EXPECT_LE(truth, result.value + kRelative);  // pairs only ever lose by it
      EXPECT_GE(truth, result.value - result.error_bound - kRelative);
    }
  }
}

TEST(Rqe, TruncationIsBoundedTightlyEnoughToBeOfUse) {
  const auto cloud = test::room_corner(3000, 3, 0.01, 2);
  EXPECT_LT(rqe(cloud.view(), {}, {.sigma = 0.1, .cutoff = 7}).error_bound, 5e-3);
  EXPECT_LT(rqe(cloud.view(), {}, {.sigma = 0.1, .cutoff = 9}).error_bound, 1e-5);
}

TEST(Rqe, GradientIsThatOfTheSumOverAllPairs) {
  auto cloud = test::room_corner(300, 1, 0.02, 4);
  const auto weights = test::random_weights(cloud.size(), 5);
  const auto result = rqe(cloud.view(), weights, {.sigma = 0.1, .cutoff = 9});
  const auto entropy = [&] { return -std::log(test::energy_of_all_pairs(cloud, weights, 0.1)); };
  const double step = 1e-4;
  double largest = 0;
  for (const double g : result.gradient.z) largest = std::max(largest, std::abs(g));
  for (std::size_t i = 0; i < cloud.size(); i += 23) {
    for (const auto& [axis, gradient] :
         {std::pair{&cloud.x, &result.gradient.x}, std::pair{&cloud.y, &result.gradient.y},
          std::pair{&cloud.z, &result.gradient.z}}) {
      const double at = (*axis)[i];
      (*axis)[i] = at + step;
      const double above = entropy();
      (*axis)[i] = at - step;
      const double below = entropy();
      (*axis)[i] = at;
      EXPECT_NEAR((*gradient)[i], (above - below) / (2 * step), 2e-5 * largest);
    }
  }
}

TEST(Rqe, GradientSumsToNothingBecauseShiftingACloudDoesNotBlurIt) {
  const auto cloud = test::room_corner(2000, 2, 0.02, 6);
  const auto gradient = rqe(cloud.view(), {}, {.sigma = 0.05}).gradient;
  for (const auto& axis : {gradient.x, gradient.y, gradient.z}) {
    const double size =
        std::accumulate(axis.begin(), axis.end(), 0.0, [](double a, double g) { return a + std::abs(g); });
    EXPECT_NEAR(std::accumulate(axis.begin(), axis.end(), 0.0), 0, 1e-6 * size);
  }
}

TEST(Rqe, DoesNotDependOnTheOrderOfThePoints) {
  const auto cloud = test::room_corner(1000, 2, 0.02, 7);
  const auto weights = test::random_weights(cloud.size(), 8);
  std::vector<std::size_t> order(cloud.size());
  std::iota(order.begin(), order.end(), 0);
  std::ranges::shuffle(order, std::mt19937_64(9));
  Vectors shuffled;
  std::vector<double> shuffled_weights;
  for (const std::size_t i : order) {
    test::add(shuffled, cloud.x[i], cloud.y[i], cloud.z[i]);
    shuffled_weights.push_back(weights[i]);
  }
  const auto one = rqe(cloud.view(), weights, {.sigma = 0.05});
  const auto other = rqe(shuffled.view(), shuffled_weights, {.sigma = 0.05});
  EXPECT_EQ(one.pairs, other.pairs);
  EXPECT_NEAR(one.value, other.value, 1e-6);
  for (std::size_t k = 0; k < order.size(); ++k) {
    EXPECT_NEAR(other.gradient.x[k], one.gradient.x[order[k]], 1e-5);
  }
}

TEST(Rqe, CountsOnlyTheRatiosOfWeights) {
  const auto cloud = test::room_corner(500, 1, 0.02, 10);
  auto weights = test::random_weights(cloud.size(), 11);
  const auto one = rqe(cloud.view(), weights, {.sigma = 0.05});
  for (double& w : weights) w *= 1e-200;
  const auto other = rqe(cloud.view(), weights, {.sigma = 0.05});
  EXPECT_NEAR(one.value, other.value, 1e-6);
  EXPECT_NEAR(one.gradient.z[3], other.gradient.z[3], 1e-5);
}

TEST(Rqe, TakesAWeightOfTwoForTwoPoints) {
  auto cloud = test::room_corner(500, 1, 0.02, 12);
  std::vector<double> weights(cloud.size(), 1);
  weights[7] = 2;
  const double weighted = rqe(cloud.view(), weights, {.sigma = 0.05}).value;
  test::add(cloud, cloud.x[7], cloud.y[7], cloud.z[7]);
  EXPECT_NEAR(rqe(cloud.view(), {}, {.sigma = 0.05}).value, weighted, 1e-6);
}

TEST(Rqe, IsTheSameToTheLastBitOnAnyNumberOfThreads) {
  const auto cloud = test::room_corner(20000, 3, 0.02, 13);
  const auto weights = test::random_weights(cloud.size(), 14);
  const auto many = rqe(cloud.view(), weights, {.sigma = 0.03});
  const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
  const auto one = rqe(cloud.view(), weights, {.sigma = 0.03});
  EXPECT_EQ(one.energy, many.energy);
  EXPECT_EQ(one.error_bound, many.error_bound);
  EXPECT_EQ(one.gradient.x, many.gradient.x);
  EXPECT_EQ(one.gradient.y, many.gradient.y);
  EXPECT_EQ(one.gradient.z, many.gradient.z);
}

TEST(Rqe, StandsHugeCoordinatesAndFarOutliers) {
  auto cloud = test::room_corner(1000, 2, 0.02, 15);
  const double here = rqe(cloud.view(), {}, {.sigma = 0.05}).energy;
  for (double& x : cloud.x) x += 4.5e6;
  EXPECT_NEAR(rqe(cloud.view(), {}, {.sigma = 0.05}).energy / here, 1, 1e-6);
  test::add(cloud, -1e12, 1e12, 1e12);
  const double with_outlier = rqe(cloud.view(), {}, {.sigma = 0.05}).energy;
  const double self = std::pow(4 * kPi * 0.05 * 0.05, -1.5);
  EXPECT_NEAR(with_outlier, (here * 1000 * 1000 + self) / (1001.0 * 1001.0), 2e-5 * here);
}

TEST(Rqe, LeavesTheGradientOutWhenItIsNotRequested) {
  const auto cloud = test::room_corner(1000, 2, 0.02, 16);
  const auto with = rqe(cloud.view(), {}, {.sigma = 0.05});
  const auto without = rqe(cloud.view(), {}, {.sigma = 0.05, .gradient = false});
  EXPECT_EQ(without.gradient.size(), 0U);
  EXPECT_NEAR(without.value, with.value, 1e-7);
}

TEST(Rqe, RefusesWhatCannotBeMeasured) {
  const auto cloud = test::random_cube(3, 1, 17);
  const Vectors none;
  EXPECT_THROW(rqe(none.view(), {}, {}), Error);
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    auto damaged = cloud;
    damaged.y[1] = bad;
    EXPECT_THROW(rqe(damaged.view(), {}, {}), Error);
    EXPECT_THROW(rqe(cloud.view(), std::vector<double>{1, bad, 1}, {}), Error);
    EXPECT_THROW(rqe(cloud.view(), {}, {.sigma = bad}), Error);
    EXPECT_THROW(rqe(cloud.view(), {}, {.cutoff = bad}), Error);
  }
  EXPECT_THROW(rqe(cloud.view(), std::vector<double>{1, 1}, {}), Error);
  EXPECT_THROW(rqe(cloud.view(), std::vector<double>{1, 1, -1}, {}), Error);
  EXPECT_THROW(rqe(cloud.view(), std::vector<double>{0, 0, 0}, {}), Error);
  EXPECT_THROW(rqe(cloud.view(), {}, {.sigma = 0}), Error);
  EXPECT_THROW(rqe(cloud.view(), {}, {.cutoff = 0.5}), Error);
  EXPECT_THROW(rqe({cloud.x, cloud.y, none.z}, {}, {}), Error);
}

}  // namespace
}  // namespace crisp
