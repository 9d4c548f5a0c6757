// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include <crisp/rqe.hpp>

#include "pipeline/quality/searches.hpp"
#include "pipeline/quality/spatial_order.hpp"
#include "pipeline/quality/sum_on_lattice.hpp"
#include "pipeline/quality/sum_over_tiles.hpp"
#include "tests/pipeline/quality/clouds.hpp"

namespace crisp {
namespace {

using namespace crisp::quality;

double gaussian(double distance, double sigma) {
  return std::exp(-distance * distance / (4 * sigma * sigma));
}

TEST(SumOnLattice, ErrsWithinItsBoundWhereverTwoPointsLie) {
  const double sigma = 0.3;
  const TruncatedGaussian kernel(sigma, 7);
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> place(-1, 1);
  std::uniform_real_distribution<double> apart(-2 * sigma, 2 * sigma);
  double worst = 0;
  double worst_gradient = 0;
  for (int trial = 0; trial < 500; ++trial) {
    const double x = place(random);
    const double y = place(random);
    const double z = place(random);
    const std::array<double, 3> d{apart(random), apart(random), apart(random)};
    // The third point only makes the lattice as wide as those that are used.
    const Vectors cloud{{x, x + d[0], x + 5}, {y, y + d[1], y}, {z, z + d[2], z}};
    const auto sums = sum_on_lattice(cloud.view(), std::vector<double>{1, 1, 0}, kernel, true);
    const double g = gaussian(std::hypot(d[0], d[1], d[2]), sigma);
    worst = std::max(worst, std::abs(sums.kernel - 2 - 2 * g) / 4);  // of four ordered pairs
    worst_gradient = std::max(worst_gradient, std::abs(sums.gradient.y[1] - d[1] * g));
  }
  EXPECT_LT(worst, kLatticeError);
  EXPECT_GT(worst, 0.1 * kLatticeError);  // the bound is not far above the actual error
  EXPECT_LT(worst_gradient, 20 * kLatticeError * sigma);
}

TEST(SumOnLattice, AgreesWithTheSumOverAllPairs) {
  const auto cloud = test::room_corner(500, 5, 0.01, 1);
  const auto weights = with_mean_one(test::random_weights(500, 2), 500);
  for (const double sigma : {0.15, 0.5, 3.0, 100.0}) {
    const TruncatedGaussian kernel(sigma, 12);
    const auto sums = sum_on_lattice(cloud.view(), weights, kernel, true);
    ExactSearch exact;
    const auto truth = exact.sums(cloud.view(), weights, kernel, {});
    EXPECT_NEAR(sums.kernel, truth.kernel, kLatticeError * 500 * 500) << sigma;
    double size = 0;
    for (const double gradient : truth.gradient.x) size = std::max(size, std::abs(gradient));
    for (std::size_t i = 0; i < 500; i += 7)
      EXPECT_NEAR(sums.gradient.x[i], truth.gradient.x[i], 1e-4 * size) << sigma;
  }
}

TEST(SumOnLattice, ItsGradientIsThatOfItsValue) {
  auto cloud = test::room_corner(50, 2, 0.01, 3);
  const auto weights = with_mean_one(test::random_weights(50, 4), 50);
  const TruncatedGaussian kernel(0.4, 7);
  const auto sums = sum_on_lattice(cloud.view(), weights, kernel, true);
  const double step = 1e-4;
  for (std::size_t i = 0; i < 50; i += 5) {
    const double at = cloud.y[i];
    cloud.y[i] = at + step;
    const double above = sum_on_lattice(cloud.view(), weights, kernel, false).kernel;
    cloud.y[i] = at - step;
    const double below = sum_on_lattice(cloud.view(), weights, kernel, false).kernel;
    cloud.y[i] = at;
    // The sum has xᵢ in both orders of its pairs, and block_scores by −1/(2 exponent) of a derivative.
    const double slope = -4 * kernel.exponent * sums.gradient.y[i];
    EXPECT_NEAR(slope, (above - below) / (2 * step), 1e-5 * std::abs(slope) + 1e-5);
  }
}

TEST(SumOnLattice, IsTheSameToTheLastBitOnAnyNumberOfThreads) {
  const auto cloud = test::room_corner(5000, 20, 0.01, 5);
  const std::vector<double> weights(5000, 1);
  const TruncatedGaussian kernel(0.5, 7);
  const auto many = sum_on_lattice(cloud.view(), weights, kernel, true);
  const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
  const auto one = sum_on_lattice(cloud.view(), weights, kernel, true);
  EXPECT_EQ(one.kernel, many.kernel);
  EXPECT_EQ(one.gradient.x, many.gradient.x);
  EXPECT_EQ(one.gradient.z, many.gradient.z);
}

TEST(SumOnLattice, IsChosenForWideKernelsAndAgreesWithPairsThere) {
  const auto cloud = test::room_corner(20000, 4, 0.01, 6);
  const auto wide = rqe(cloud.view(), {}, {.sigma = 0.4, .cutoff = 9});
  EXPECT_EQ(wide.tested, 0U);
  EXPECT_GT(rqe(cloud.view(), {}, {.sigma = 0.02}).tested, 0U);
  const TruncatedGaussian kernel(0.4, 9);
  const std::vector<double> weights(20000, 1);
  const Tiles tiles(cloud.view(), kernel.radius, spatial_order(cloud.view(), kernel.radius).index);
  const auto pairs = sum_over_tiles(tiles, cloud.view(), weights, kernel, true);
  const double energy = kernel.peak * pairs.kernel / (20000.0 * 20000.0);
  EXPECT_NEAR(wide.value, -std::log(energy), wide.error_bound);
  EXPECT_LT(wide.error_bound, 5e-4);
  const double scale = 4 * kernel.exponent / pairs.kernel;
  for (std::size_t i = 0; i < 20000; i += 999) {
    EXPECT_NEAR(wide.gradient.x[i], scale * pairs.gradient.x[i], 1e-4 * 2 / 20000.0 / 0.4);
  }
}

}  // namespace
}  // namespace crisp
