// SPDX-License-Identifier: BSD-3-Clause
// Quantized ranges are detected, and others are not.
#include "plugins/diagnose/noise/range_quantization.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <random>

namespace crisp {
namespace {

using namespace crisp::diagnose;

TEST(RangeQuantization, IsDetectedInMultiplesOnly) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<float> range(1, 9);
  std::vector<float> ranges;
  std::vector<std::uint32_t> blocks;
  for (std::uint32_t i = 0; i < 20'000; ++i) {
    ranges.push_back(range(random));
    blocks.push_back(i / 100);
  }
  EXPECT_FALSE(range_quantization("laser1", ranges, blocks, 1));
  for (float& one : ranges) one = 0.004F * std::round(one / 0.004F);
  const auto found = range_quantization("laser1", ranges, blocks, 1);
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->parameters[0].value, 0.004, 1e-7);
  // Nearly all of 20 000 ranges lie in a quarter of the cells.
  EXPECT_NEAR(found->log10_bayes_factor, 20'000 * std::log10(4), 300);
}

TEST(RangeQuantization, HasTheGainOfHeldOutBlocks) {
  std::mt19937_64 random(2);
  std::uniform_real_distribution<float> range(1, 9);
  std::bernoulli_distribution outlier(0.1);
  std::vector<float> ranges;
  std::vector<std::uint32_t> blocks;
  for (std::uint32_t i = 0; i < 20'000; ++i) {
    const float one = range(random);
    ranges.push_back(outlier(random) ? one : 0.004F * std::round(one / 0.004F));
    blocks.push_back(i / 100);
  }
  const auto found = range_quantization("laser1", ranges, blocks, 1);
  ASSERT_TRUE(found);
  const Gain& gain = found->gain.at(0);
  // A quarter of the outliers lies on a step by chance.
  constexpr double kOn = 0.9 + 0.1 / 4;
  EXPECT_NEAR(gain.after - gain.before, kOn * std::log(kOn / 0.25) + (1 - kOn) * std::log((1 - kOn) / 0.75),
              0.03);
  EXPECT_GT(gain.ci95[1] - gain.ci95[0], 0.005);
  EXPECT_TRUE(found->accepted);
  EXPECT_FALSE(
      range_quantization("laser1", ranges, std::vector<std::uint32_t>(ranges.size(), 0), 1)->accepted)
      << "none is held out";
}

TEST(RangeQuantization, TheStepsErrorIsThatOfRoundedRanges) {
  // The telegram rounds to millimetres: steps of 4 mm and a ten thousandth are found by their drift over the
  // ranges.
  constexpr int kRuns = 20;
  double squares = 0;
  for (std::uint64_t seed = 0; seed < kRuns; ++seed) {
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<float> range(1, 9);
    const double step = 0.004 + 1e-6 * std::uniform_real_distribution<double>(-1, 1)(random);
    std::vector<float> ranges;
    std::vector<std::uint32_t> blocks;
    for (std::uint32_t i = 0; i < 5000; ++i) {
      const double on_step = step * std::round(double{range(random)} / step);
      ranges.push_back(static_cast<float>(0.001 * std::round(on_step / 0.001)));
      blocks.push_back(i / 100);
    }
    const auto found = range_quantization("laser1", ranges, blocks, seed);
    ASSERT_TRUE(found);
    const Parameter& one = found->parameters[0];
    squares += (one.value - step) * (one.value - step) / (one.std_error * one.std_error);
  }
  // The error follows from how multiples of the step fall between millimetres, and is no normal noise.
  EXPECT_GT(std::sqrt(squares / kRuns), 0.3);
  EXPECT_LT(std::sqrt(squares / kRuns), 1.7);
}

}  // namespace
}  // namespace crisp
