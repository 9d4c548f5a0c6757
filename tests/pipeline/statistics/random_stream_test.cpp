// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/statistics/random_stream.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <map>
#include <string>

#include "tests/support/moments.hpp"

namespace crisp {
namespace {

using namespace crisp::statistics;
using test::kDraws;
using test::moments;

TEST(RandomStream, DrawsNormalNumbersWithTheMomentsOfTheNormalDistribution) {
  RandomStream random(1, "test");
  const auto found = moments([&] { return random.normal(); });
  EXPECT_NEAR(found.mean, 0, 4 * std::sqrt(1.0 / kDraws));
  EXPECT_NEAR(found.variance, 1, 4 * std::sqrt(2.0 / kDraws));
  EXPECT_NEAR(found.kurtosis, 3, 4 * std::sqrt(96.0 / kDraws));
}

TEST(RandomStream, DrawsUniformAndExponentialNumbersWithTheirMeansAndVariances) {
  RandomStream random(2, "test");
  const auto uniform = moments([&] { return random.uniform(-1, 3); });
  EXPECT_NEAR(uniform.mean, 1, 4 * std::sqrt(16.0 / 12 / kDraws));
  EXPECT_NEAR(uniform.variance, 16.0 / 12, 0.02);
  const auto exponential = moments([&] { return random.exponential(0.5); });
  EXPECT_NEAR(exponential.mean, 0.5, 4 * 0.5 / std::sqrt(kDraws));
  EXPECT_NEAR(exponential.variance, 0.25, 4 * 0.25 * std::sqrt(8.0 / kDraws));
}

TEST(RandomStream, DrawsWholeNumbersBelowALimitEquallyOften) {
  RandomStream random(3, "test");
  constexpr std::size_t kKinds = 6;
  std::array<int, kKinds> counts{};
  for (int i = 0; i < kDraws; ++i) ++counts.at(random.below(kKinds));
  constexpr double kExpected = static_cast<double>(kDraws) / kKinds;
  for (const int count : counts) EXPECT_NEAR(count, kExpected, 5 * std::sqrt(kExpected));
  EXPECT_EQ(random.below(1), 0U);
}

TEST(RandomStream, DrawsBothSignsEquallyOften) {
  RandomStream random(4, "test");
  const auto found = moments([&] { return random.sign(); });
  EXPECT_NEAR(found.mean, 0, 4 / std::sqrt(kDraws));
  EXPECT_NEAR(found.variance, 1, 0.01);
}

TEST(RandomStream, ShufflesIntoEachOrderEquallyOften) {
  RandomStream random(5, "test");
  std::map<std::string, int> counts;
  constexpr int kShuffles = 60'000;
  for (int i = 0; i < kShuffles; ++i) {
    std::string letters = "abc";
    random.shuffle(letters);
    ++counts[letters];
  }
  EXPECT_EQ(counts.size(), 6U);
  for (const auto& [order, count] : counts) EXPECT_NEAR(count, kShuffles / 6.0, 500) << order;
}

TEST(RandomStream, RepeatsItselfForTheSameSeedAndNameOnly) {
  RandomStream one(7, "laser1.noise");
  RandomStream same(7, "laser1.noise");
  RandomStream other_name(7, "laser2.noise");
  RandomStream other_seed(8, "laser1.noise");
  const auto first = one.bits();
  EXPECT_EQ(first, same.bits());
  EXPECT_NE(first, other_name.bits());
  EXPECT_NE(first, other_seed.bits());
}

}  // namespace
}  // namespace crisp
