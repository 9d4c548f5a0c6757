// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/devices/rough_clock.hpp"

#include <gtest/gtest.h>

#include <random>

namespace crisp {
namespace {

using namespace crisp::devices;

TEST(RoughClock, SeesAClockThatWasSetBack) {
  RoughClock watch;
  EXPECT_FALSE(watch.take({0, 3'000'000'000U}));
  EXPECT_FALSE(watch.take({20'000'000, 3'000'020'000U}));
  EXPECT_TRUE(watch.take({10'000'000'000, 100'000U}));
  EXPECT_FALSE(watch.take({10'020'000'000, 120'000U}));
}

TEST(RoughClock, TakesAWrapAndASilenceForWhatTheyAre) {
  RoughClock watch;
  EXPECT_FALSE(watch.take({0, 4'294'960'000U}));
  EXPECT_FALSE(watch.take({20'000'000, 12'704U})) << "the clock wraps at 2^32";
  const std::int64_t two_hours_us = 7'200'000'000;
  EXPECT_FALSE(
      watch.take({20'000'000 + two_hours_us * 1000, static_cast<std::uint32_t>(12'704 + two_hours_us)}));
}

TEST(RoughClock, TakesALateDeliveryForNoRestart) {
  RoughClock watch;
  EXPECT_FALSE(watch.take({0, 1'000'000}));
  EXPECT_FALSE(watch.take({30'000'000'000, 1'020'000})) << "held up for 30 s";
  EXPECT_FALSE(watch.take({30'000'100'000, 31'000'000})) << "and then on time again";
  EXPECT_FALSE(watch.take({30'000'200'000, 30'999'000})) << "datagrams may change places";
}

/// Stamps of a clock that is `skew` slow, `rate` a second, with delays of an exponential law, mean 0.3 ms.
std::optional<double> skew_found(double skew, double seconds, double rate, std::uint32_t first_us) {
  std::mt19937 random(7);
  std::exponential_distribution<double> delay(1 / 0.3e-3);
  RoughClock clock;
  for (double t = 0; t < seconds; t += 1 / rate) {
    const auto device_us = static_cast<std::uint64_t>(1e6 * t) + first_us;
    const double receipt = t * (1 + skew) + delay(random);
    EXPECT_FALSE(
        clock.take({static_cast<std::int64_t>(1e9 * receipt), static_cast<std::uint32_t>(device_us)}));
  }
  return clock.skew();
}

TEST(RoughClock, EstimatesAClocksSkew) {
  // The least of n delays lies 0.3 ms / n above none; over half the time that makes 0.3 ms / 50 / 30 s = 0.2
  // ppm.
  for (const double skew : {-250e-6, 0.0, 40e-6}) EXPECT_NEAR(*skew_found(skew, 60, 50, 5), skew, 0.6e-6);
}

TEST(RoughClock, FollowsAClockAcrossItsWrapForHours) {
  EXPECT_NEAR(*skew_found(30e-6, 3 * 3600, 10, 4'294'000'000U), 30e-6, 0.1e-6);
}

TEST(RoughClock, IsEmptyForAFewSeconds) { EXPECT_FALSE(skew_found(30e-6, 9, 50, 0)); }

}  // namespace
}  // namespace crisp
