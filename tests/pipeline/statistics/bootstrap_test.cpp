// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/statistics/bootstrap.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <random>

namespace crisp {
namespace {

using namespace crisp::statistics;

double mean_of(const std::vector<double>& values, const std::vector<std::size_t>& drawn) {
  double sum = 0;
  for (const std::size_t i : drawn) sum += values[i];
  return sum / static_cast<double>(drawn.size());
}

TEST(Bootstrap, HasItsNominalCoverageForIndependentValues) {
  constexpr int kTrials = 400;
  constexpr std::size_t kValues = 100;
  std::mt19937_64 random(1);
  std::exponential_distribution<> skewed(1);
  int covered = 0;
  for (int trial = 0; trial < kTrials; ++trial) {
    std::vector<double> values(kValues);
    for (double& value : values) value = skewed(random);
    const Spread spread = bootstrap(kValues, 1, static_cast<std::uint64_t>(trial), 400,
                                    [&](const auto& drawn) { return mean_of(values, drawn); });
    covered += spread.ci95[0] < 1 && 1 < spread.ci95[1] ? 1 : 0;
  }
  // 93 % are expected of percentiles of a skewed mean; four binomial standard deviations are 5 %.
  EXPECT_GT(covered, 0.88 * kTrials);
  EXPECT_LT(covered, 0.98 * kTrials);
}

TEST(Bootstrap, OfBlocksSeesWhatNeighboursShare) {
  constexpr std::size_t kValues = 4000;
  constexpr std::size_t kShared = 20;
  std::mt19937_64 random(2);
  std::normal_distribution<> normal;
  std::vector<double> values(kValues);
  for (std::size_t i = 0; i < kValues; ++i) values[i] = i % kShared == 0 ? normal(random) : values[i - 1];
  const auto error = [&](std::size_t block) {
    return bootstrap(kValues, block, 3, 500, [&](const auto& drawn) { return mean_of(values, drawn); })
        .std_error;
  };
  const double truth = 1 / std::sqrt(double{kValues} / double{kShared});
  EXPECT_NEAR(error(10 * kShared), truth, 0.25 * truth);
  EXPECT_LT(error(1), 0.35 * truth) << "as if all were independent";
}

TEST(Bootstrap, OfNothingGivesNothing) {
  EXPECT_EQ(bootstrap(0, 5, 1, 100, [](const auto&) { return 1.0; }).std_error, 0);
  EXPECT_EQ(bootstrap(5, 5, 1, 100, [](const auto&) { return std::nan(""); }).std_error, 0);
}

}  // namespace
}  // namespace crisp
