// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/statistics/multiple_testing.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace crisp {
namespace {

using namespace crisp::statistics;

double uniform(std::mt19937_64& random) { return std::uniform_real_distribution<>(0, 1)(random); }

TEST(SidakPValue, IsUniformUnderTheNull) {
  constexpr int kTrials = 20'000;
  constexpr int kTests = 7;
  std::mt19937_64 random(1);
  int below = 0;
  for (int trial = 0; trial < kTrials; ++trial) {
    double least = 1;
    for (int test = 0; test < kTests; ++test) least = std::min(least, uniform(random));
    below += sidak_p_value(kTests, least) < 0.05 ? 1 : 0;
  }
  EXPECT_NEAR(below, 0.05 * kTrials, 4 * std::sqrt(0.05 * 0.95 * kTrials));
}

TEST(SidakPValue, KeepsItsDigitsWhereItIsSmall) {
  EXPECT_NEAR(sidak_p_value(12, 1e-30), 1.2e-29, 1e-40);
  EXPECT_EQ(sidak_p_value(12, 0), 0);
  EXPECT_EQ(sidak_p_value(12, 1), 1);
}

TEST(EffectiveNumberOfTests, IsThatOfIndependentOnesAndLessOfDependentOnes) {
  constexpr int kTrials = 20'000;
  constexpr double kError = 4 / 141.4;  // four standard errors, relatively: 4 / sqrt(kTrials)
  std::mt19937_64 random(2);
  std::vector<double> independent;
  std::vector<double> alike;
  for (int trial = 0; trial < kTrials; ++trial) {
    double least = 1;
    for (int test = 0; test < 6; ++test) least = std::min(least, uniform(random));
    independent.push_back(least);
    alike.push_back(uniform(random));  // of six that are one and the same
  }
  EXPECT_NEAR(effective_number_of_tests(independent), 6, 6 * kError);
  EXPECT_NEAR(effective_number_of_tests(alike), 1, kError);
}

}  // namespace
}  // namespace crisp
