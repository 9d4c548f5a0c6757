// SPDX-License-Identifier: BSD-3-Clause
// Ranges that are multiples of a step are told from others.
#include "plugins/diagnose/comb.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <random>

namespace crisp {
namespace {

TEST(AStep, IsNotSeenInRangesOfAnyKindButMultiples) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<float> range(1, 9);
  std::vector<float> ranges;
  std::vector<std::uint32_t> blocks;
  for (std::uint32_t i = 0; i < 20'000; ++i) {
    ranges.push_back(range(random));
    blocks.push_back(i / 100);
  }
  EXPECT_FALSE(quantisation("laser1", ranges, blocks, 1));
  for (float& one : ranges) one = 0.004F * std::round(one / 0.004F);
  const auto found = quantisation("laser1", ranges, blocks, 1);
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->parameters[0].value, 0.004, 1e-7);
  // Nearly all of 20 000 ranges lie in a quarter of the places.
  EXPECT_NEAR(found->log10_odds, 20'000 * std::log10(4), 300);
}

}  // namespace
}  // namespace crisp
