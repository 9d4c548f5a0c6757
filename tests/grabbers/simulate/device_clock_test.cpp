// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/simulate/device_clock.hpp"

#include <gtest/gtest.h>

namespace crisp {
namespace {

using namespace crisp::simulate;

TEST(DeviceClock, RunsSlowByItsSkew) {
  // 100 ppm: 1.0001 hub seconds pass in a device second, so after 1000.1 s it has counted 1000.
  const DeviceClock clock{.start = 5, .skew = 1e-4};
  EXPECT_NEAR(clock.seconds(0), 5, 1e-12);
  EXPECT_NEAR(clock.seconds(1000.1), 1005, 1e-9);
}

TEST(DeviceClock, LosesTimeQuadraticallyWhenItsSkewGrows) {
  // The skew grows by 1e-6 a second: after 100 s the device is 1e-6 · 100² / 2 s = 5 ms behind.
  const DeviceClock clock{.drift = 1e-6};
  EXPECT_NEAR(clock.seconds(100), 100 - 0.005, 1e-12);
}

TEST(DeviceClock, JumpsAtItsStep) {
  const DeviceClock clock{.start = 5, .resets = {20}, .step = {.at = 10, .by = 0.25}};
  EXPECT_NEAR(clock.seconds(9.999), 14.999, 1e-12);
  EXPECT_NEAR(clock.seconds(10), 15.25, 1e-12);
  EXPECT_NEAR(clock.seconds(23), 3, 1e-12) << "after a reset it counts from zero";
}

TEST(DeviceClock, CountsWholeMicrosecondsThatWrapAt32Bits) {
  const DeviceClock clock{.start = 4294.967290};
  EXPECT_EQ(clock.microseconds(0.0000025), 4294967292U);
  EXPECT_EQ(clock.microseconds(0.0000065), 0U);
  EXPECT_EQ(clock.microseconds(1.0000065), 1'000'000U);
}

TEST(DeviceClock, StartsAgainFromZeroAtAReset) {
  const DeviceClock clock{.start = 50, .skew = 1e-4, .resets = {10, 20}};
  EXPECT_NEAR(clock.seconds(9.5), 50 + 9.5 / 1.0001, 1e-12);
  EXPECT_NEAR(clock.seconds(10), 0, 1e-12);
  EXPECT_NEAR(clock.seconds(11.0001), 1, 1e-12);
  EXPECT_NEAR(clock.seconds(25.0005), 5, 1e-12);
  EXPECT_EQ(clock.resets_before(9.9), 0U);
  EXPECT_EQ(clock.resets_before(25), 2U);
}

}  // namespace
}  // namespace crisp
