// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/statistics/monte_carlo_test.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace crisp {
namespace {

using namespace crisp::statistics;

TEST(MonteCarloTest, CountsTheObservationAsADraw) {
  const std::vector<double> draws = {1, 5, 3, 2, 4};
  std::size_t next = 0;
  const auto test = monte_carlo_test(3, draws.size(), [&] { return draws[next++]; });
  EXPECT_EQ(next, 5U);
  EXPECT_DOUBLE_EQ(test.p_value, 4.0 / 6) << "5, 3, 4 and the observation reach 3";
  EXPECT_DOUBLE_EQ(test.mean, 3);
  EXPECT_DOUBLE_EQ(monte_carlo_test(9, 99, [] { return 0.0; }).p_value, 0.01) << "never 0";
}

/// Permutation test of the first half's mean against the second's, in values that are all alike.
double p_value_of_no_difference(std::mt19937_64& random) {
  std::vector<double> values(20);
  std::normal_distribution<double> draw;
  for (double& value : values) value = draw(random);
  const auto difference = [&] {
    double sum = 0;
    for (std::size_t i = 0; i < values.size(); ++i) sum += i < values.size() / 2 ? values[i] : -values[i];
    return std::abs(sum);
  };
  const double observed = difference();
  return monte_carlo_test(observed, 99,
                          [&] {
                            std::ranges::shuffle(values, random);
                            return difference();
                          })
      .p_value;
}

TEST(MonteCarloTest, HasTheStatedLevelUnderTheNull) {
  std::mt19937_64 random(5);
  constexpr int kTrials = 4000;
  for (const double level : {0.05, 0.2}) {
    int rejected = 0;
    for (int trial = 0; trial < kTrials; ++trial) {
      rejected += p_value_of_no_difference(random) <= level ? 1 : 0;
    }
    const double four_sigma = 4 * std::sqrt(level * (1 - level) / kTrials);
    EXPECT_NEAR(static_cast<double>(rejected) / kTrials, level, four_sigma) << level;
  }
}

}  // namespace
}  // namespace crisp
