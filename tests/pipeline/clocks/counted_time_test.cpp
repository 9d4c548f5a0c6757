// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/clocks/counted_time.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

namespace crisp {
namespace {

using namespace crisp::clocks;

constexpr double kPeriod = 0.0201;  // [s]

/// What a counter makes of stamps at even times, each off by some jitter and then changed by `change`.
template <class Change>
std::vector<double> jumped_of(std::size_t n, double jitter, const Change& change, std::uint64_t seed = 7) {
  std::mt19937_64 random(seed);
  std::normal_distribution<> off(0, jitter);
  CountedTime counted;
  std::vector<double> jumped;
  double last = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const double stamp = kPeriod * static_cast<double>(i) + off(random) + change(i);
    if (i > 0) counted.add(stamp - last, 1, kPeriod);
    last = stamp;
    jumped.push_back(counted.jumped());
  }
  return jumped;
}

TEST(CountedTime, FindsAJumpOfTheClockAndKeepsIt) {
  for (const double by : {0.5e-3, -0.5e-3, 0.03, -0.015}) {
    const auto jumped = jumped_of(200, 20e-6, [=](std::size_t i) { return i >= 50 ? by : 0; });
    EXPECT_EQ(jumped[49], 0);
    EXPECT_NEAR(jumped[50], by, 4 * std::sqrt(2.0) * 20e-6);
    EXPECT_EQ(jumped.back(), jumped[50]) << "and nothing else is one";
  }
}

TEST(CountedTime, TakesReadingsThatComeUnevenlyForNoJumps) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const auto jumped = jumped_of(
        20'000, 0.2e-3, [](std::size_t) { return 0; }, seed);
    EXPECT_EQ(jumped.back(), 0) << seed;
  }
}

TEST(CountedTime, IsNotMisledByFirstIntervalsThatAreEvenByChance) {
  // Of a plate whose readings come within 3 % of 3.5 ms: the first nine stamps are far more even.
  CountedTime counted;
  for (const double interval :
       {3.518e-3, 3.521e-3, 3.583e-3, 3.465e-3, 3.546e-3, 3.506e-3, 3.621e-3, 3.527e-3, 3.164e-3, 3.663e-3,
        3.823e-3, 3.276e-3, 3.645e-3, 3.602e-3, 3.568e-3, 3.317e-3}) {
    counted.add(interval, 1, 3.5e-3);
    EXPECT_EQ(counted.jumped(), 0);
  }
}

TEST(CountedTime, TakesFewReadingsThatComeUnevenlyForNoJumps) {
  int jumps = 0;
  for (std::uint64_t seed = 1; seed <= 5000; ++seed) {
    const auto jumped = jumped_of(
        64, 0.12e-3, [](std::size_t) { return 0; }, seed);
    jumps += jumped.back() != 0 ? 1 : 0;
  }
  EXPECT_LE(jumps, 5);
}

TEST(CountedTime, IsSureOnlyAfterSomeEvenIntervals) {
  CountedTime counted;
  for (int i = 0; i < 20; ++i) counted.add(kPeriod, 1, kPeriod);
  EXPECT_TRUE(counted.is_sure());
  counted.add(kPeriod + 2e-3, 1, kPeriod);
  EXPECT_FALSE(counted.is_sure());
  for (int i = 0; i < 3; ++i) counted.add(kPeriod, 1, kPeriod);
  EXPECT_FALSE(counted.confirmed());
  counted.add(kPeriod, 1, kPeriod);
  EXPECT_TRUE(counted.is_sure());
  ASSERT_TRUE(counted.confirmed());
  EXPECT_NEAR(*counted.confirmed(), 2e-3, 1e-12);
  counted.add(kPeriod, 1, kPeriod);
  EXPECT_FALSE(counted.confirmed()) << "reported once";
}

TEST(CountedTime, TakesOneStampThatIsOffForNoJump) {
  const auto jumped = jumped_of(190, 20e-6, [](std::size_t i) { return i % 40 == 39 ? 1e-3 : 0; });
  EXPECT_EQ(jumped.back(), 0);
}

TEST(CountedTime, TakesAnotherRateForNoJump) {
  const auto jumped = jumped_of(200, 0, [](std::size_t i) { return i > 50 ? 2e-3 * double(i - 50) : 0; });
  EXPECT_EQ(jumped.back(), 0);
}

TEST(CountedTime, FollowsAMirrorThatWandersOrSpinsUp) {
  const auto wanders = [](std::size_t i) { return 3e-4 * std::sin(0.15 * double(i)); };  // 0.2 % of the rate
  EXPECT_EQ(jumped_of(2000, 20e-6, wanders).back(), 0);
  const auto spins_up = [](std::size_t i) { return -0.02 * std::exp(-0.1 * double(i)); };
  EXPECT_EQ(jumped_of(2000, 20e-6, spins_up).back(), 0);
}

TEST(CountedTime, TakesWhatWasNeitherSentNorCountedForNoJump) {
  CountedTime counted;
  for (int i = 0; i < 20; ++i) counted.add(kPeriod, 1, kPeriod);
  counted.add(3 * kPeriod, 1, 3 * kPeriod + 1e-3);  // two were left out, as the receipts show
  EXPECT_EQ(counted.jumped(), 0);
  counted.add(3 * kPeriod, 3, 3 * kPeriod);  // two were lost on the way
  EXPECT_EQ(counted.jumped(), 0);
  counted.add(3 * kPeriod, 1, kPeriod);  // the clock jumped by two periods: the receipts know nothing of it
  EXPECT_NEAR(counted.jumped(), 2 * kPeriod, 1e-9);
}

TEST(CountedTime, TakesBurstsThatTheReceiptsConfirmForNoJump) {
  CountedTime counted;
  for (int i = 0; i < 400; ++i) {
    const double interval = i % 25 == 24 ? 0.001 : i % 25 == 23 ? 0.07 : 0.0133;
    counted.add(interval, 1, interval);
    EXPECT_EQ(counted.jumped(), 0) << i;
  }
}

TEST(CountedTime, IgnoresUnevenIntervals) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<> any(0.001, 0.1);
  CountedTime counted;
  for (int i = 0; i < 1000; ++i) {
    const double interval = any(random);
    counted.add(interval, 1, interval);
    EXPECT_EQ(counted.jumped(), 0);
  }
}

}  // namespace
}  // namespace crisp
