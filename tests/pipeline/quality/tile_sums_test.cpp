// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/quality/tile_sums.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

#include "pipeline/quality/spatial_order.hpp"
#include "pipeline/quality/sum_over_tiles.hpp"
#include "tests/pipeline/quality/clouds.hpp"
#include "tests/support/instruction_sets.hpp"

namespace crisp {
namespace {

using namespace crisp::quality;

class TileSums : public test::EachInstructionSet {};

INSTANTIATE_TEST_SUITE_P(All, TileSums, testing::ValuesIn(test::instruction_sets()),
                         test::name_of_instruction_set);

TEST_P(TileSums, AreMadeWithTheInstructionSetThatIsRequested) {
  EXPECT_STREQ(simd::instruction_set(), hwy::TargetName(GetParam()));
}

TEST_P(TileSums, HaveAnExponentialThatErrsByLittle) {
  std::vector<float> t;
  for (int i = 0; i <= 100000; ++i) t.push_back(static_cast<float>(i) * 1e-3F);
  std::vector<float> result(t.size());
  simd::exp2_minus(t.data(), t.size(), result.data());
  double worst = 0;
  for (std::size_t i = 0; i < t.size(); ++i) {
    const double truth = std::exp2(-static_cast<double>(t[i]));
    worst = std::max(worst, std::abs(static_cast<double>(result[i]) / truth - 1));
  }
  EXPECT_LT(worst, 1.5e-7);
  EXPECT_EQ(result[0], 1);
}

TEST_P(TileSums, AgreeWithAllPairsInDoublePrecision) {
  const auto cloud = test::room_corner(2500, 2, 0.01, 1);
  const auto weights = with_mean_one(test::random_weights(2500, 2), 2500);
  const TruncatedGaussian kernel(0.05, 7);
  const Tiles tiles(cloud.view(), kernel.radius, spatial_order(cloud.view(), kernel.radius).index);
  const auto sums = sum_over_tiles(tiles, cloud.view(), weights, kernel, true);
  double truth = 0;
  Vectors gradient;
  gradient.assign(2500, 0);
  for (std::size_t i = 0; i < 2500; ++i) {
    for (std::size_t j = 0; j < 2500; ++j) {
      const double distance2 = squared_distance(cloud.view(), i, j);
      if (distance2 >= kernel.radius * kernel.radius) continue;
      const double both = weights[i] * weights[j];
      truth += both * (std::exp(-kernel.exponent * distance2) - kernel.floor);
      gradient.y[i] += both * std::exp(-kernel.exponent * distance2) * (cloud.y[i] - cloud.y[j]);
    }
  }
  EXPECT_NEAR(sums.kernel / truth, 1, 1e-7);
  double size = 0;
  for (const double p : gradient.y) size = std::max(size, std::abs(p));
  for (std::size_t i = 0; i < 2500; ++i) EXPECT_NEAR(sums.gradient.y[i], gradient.y[i], 2e-6 * size);
  EXPECT_EQ(sum_over_tiles(tiles, cloud.view(), weights, kernel, false).kernel, sums.kernel);
}

}  // namespace
}  // namespace crisp
