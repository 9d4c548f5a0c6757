// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/statistics/robust_estimators.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "pipeline/statistics/quantile_groups.hpp"

namespace crisp {
namespace {

using namespace crisp::statistics;

TEST(Quantile, IsTheValueThatTheShareLiesBelow) {
  std::vector<int> values = {5, 1, 4, 2, 3};
  EXPECT_EQ(quantile_in_place(values, 0), 1);
  EXPECT_EQ(quantile_in_place(values, 0.5), 3);
  EXPECT_EQ(quantile_in_place(values, 1), 5);
  EXPECT_EQ(median_in_place(values), 3);
  std::vector<double> none;
  EXPECT_TRUE(std::isnan(median_in_place(none)));
}

TEST(SigmaByMedian, IsTheStandardDeviationOfNormalValues) {
  constexpr std::size_t kValues = 100'000;
  std::mt19937_64 random(1);
  std::normal_distribution<> normal(0, 3);
  std::vector<double> sizes(kValues);
  for (double& size : sizes) size = std::abs(normal(random));
  // The median absolute deviation has an efficiency of 37 %.
  EXPECT_NEAR(kMadToSigma * median_in_place(sizes), 3, 4 * 3 / std::sqrt(2 * 0.37 * kValues));
}

TEST(Biweight, HasTheSlopeOfItsInfluence) {
  const auto influence = [](double share) { return share * biweight(share); };
  for (const double share : {0.0, 0.1, 0.4, 0.8, 0.99}) {
    constexpr double kStep = 1e-6;
    const double slope = (influence(share + kStep) - influence(share - kStep)) / (2 * kStep);
    EXPECT_NEAR(biweight_psi_derivative(biweight(share)), slope, 1e-6) << share;
  }
  EXPECT_EQ(biweight(1.5), 0);
}

TEST(QuantileGroups, HaveEquallyManyValuesAndKeepEqualOnesTogether) {
  std::vector<float> values;
  for (int i = 0; i < 120; ++i) values.push_back(static_cast<float>((i * 37) % 120));
  std::vector<int> counts(4);
  for (const auto group : groups_of(values, 4)) ++counts.at(group);
  EXPECT_EQ(counts, std::vector<int>(4, 30));
  const std::vector<float> same(50, 1.0F);
  const auto groups = groups_of(same, 4);
  EXPECT_EQ(std::ranges::min(groups), std::ranges::max(groups));
}

}  // namespace
}  // namespace crisp
