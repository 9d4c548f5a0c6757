// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/clocks/unwrap.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include <crisp/error.hpp>

namespace crisp {
namespace {

using namespace crisp::clocks;

constexpr std::int64_t kWrap_us = std::int64_t{1} << 32;

std::uint32_t raw(std::int64_t us) { return static_cast<std::uint32_t>(us); }
std::int64_t ns(double seconds) { return 1'700'000'000'000'000'000 + std::llround(1e9 * seconds); }

TEST(Elapsed, ResolvesTheWrapsOfTheDevicesClockByTheHubs) {
  const DeviceStamp from{.receipt_ns = ns(0), .device_us = raw(kWrap_us - 10)};
  const auto none = elapsed(from, {.receipt_ns = ns(0.5), .device_us = 20});
  EXPECT_NEAR(none.hub_s, 0.5, 1e-12);
  EXPECT_EQ(none.device_us, 30);
  EXPECT_EQ(elapsed(from, {.receipt_ns = ns(9000), .device_us = 20}).device_us, 30 + 2 * kWrap_us);
  EXPECT_EQ(elapsed(from, {.receipt_ns = ns(1), .device_us = raw(kWrap_us - 15)}).device_us, -5) << "earlier";
}

TEST(TimeUnwrapper, CountsOnPastAWrap) {
  TimeUnwrapper time("laser1");
  const std::int64_t start = kWrap_us - 30'000;
  for (int i = 0; i < 10; ++i) {
    const auto stamp = time.add(raw(start + 20'000 * i), ns(0.02 * i));
    EXPECT_EQ(stamp.kind, StampKind::next);
    EXPECT_EQ(stamp.device_us, start + 20'000 * i);
  }
}

TEST(TimeUnwrapper, FindsHowManyWrapsASilenceOfTenHoursHeld) {
  std::mt19937_64 random(1);
  for (std::int64_t trial = 0; trial < 100; ++trial) {
    const std::int64_t start = std::uniform_int_distribution<std::int64_t>(0, kWrap_us - 1)(random);
    const std::int64_t silence = 36'000'000'000 + trial * 123'456'789;
    const double skew = std::uniform_real_distribution<>(-250e-6, 250e-6)(random);
    const double late = std::exponential_distribution<>(10)(random);
    TimeUnwrapper time("laser1");
    time.add(raw(start), ns(0));
    const auto stamp =
        time.add(raw(start + silence), ns(1e-6 * static_cast<double>(silence) * (1 + skew) + late));
    EXPECT_EQ(stamp.kind, StampKind::next);
    EXPECT_EQ(stamp.device_us, start + silence);
  }
}

TEST(TimeUnwrapper, CutsAtAPowerCycleAndGoesOnByTheHubsTime) {
  TimeUnwrapper time("laser1");
  time.add(raw(5'000'000), ns(0));
  time.add(raw(5'020'000), ns(0.02));
  const auto after = time.add(raw(1'000'000), ns(20.02));
  EXPECT_EQ(after.kind, StampKind::reset);
  EXPECT_EQ(after.device_us, 25'020'000 + kResetGap_us);
  const auto next = time.add(raw(1'020'000), ns(20.04));
  EXPECT_EQ(next.kind, StampKind::next);
  EXPECT_EQ(next.device_us, 25'040'000 + kResetGap_us);
}

TEST(TimeUnwrapper, DoesNotMistakeAStalledNetworkForAReset) {
  TimeUnwrapper time("laser1");
  double receipt = 0;
  for (int i = 0; i < 2000; ++i) {
    const double sent = 0.02 * i;
    receipt = std::max(receipt + 1e-4, sent);
    if (i == 100) receipt += 25;  // the connection stands still, then hands out all that has piled up
    const auto stamp = time.add(raw(20'000 * i), ns(receipt), i == 0 ? std::nullopt : std::optional(0.02));
    ASSERT_EQ(stamp.kind, StampKind::next);
    ASSERT_EQ(stamp.device_us, 20'000 * i);
  }
}

TEST(TimeUnwrapper, CutsWhereTheClockJumpsWhileCounterAndHubGoOn) {
  for (const std::int64_t jump_us : {2'000'000, -700'000}) {
    TimeUnwrapper time("laser1");
    time.add(raw(9'000'000), ns(0));
    time.add(raw(9'020'000), ns(0.02), 0.02);
    const auto stamp = time.add(raw(9'040'000 + jump_us), ns(0.04), 0.02);
    EXPECT_EQ(stamp.kind, StampKind::reset);
    EXPECT_EQ(stamp.device_us, 9'040'000 + kResetGap_us);
  }
}

TEST(TimeUnwrapper, SetsAsideWhatComesTwiceOrTooLate) {
  TimeUnwrapper time("plate");
  time.add(raw(1'000'000), ns(0));
  time.add(raw(1'004'000), ns(0.004));
  EXPECT_EQ(time.add(raw(1'002'000), ns(0.0041)).kind, StampKind::repeated);
  EXPECT_EQ(time.add(raw(1'004'000), ns(0.0042)).kind, StampKind::repeated);
  const auto next = time.add(raw(1'006'000), ns(0.006));
  EXPECT_EQ(next.kind, StampKind::next);
  EXPECT_EQ(next.device_us, 1'006'000);
}

TEST(TimeUnwrapper, RefusesAClockThatWrapsEverySecondByTheDevicesName) {
  TimeUnwrapper time("laser2");
  const auto feed = [&] {
    for (int i = 0; i < 200; ++i) time.add(raw((164'086 + 20'000 * i) % 1'000'000), ns(0.02 * i));
  };
  try {
    feed();
    FAIL() << "was not refused";
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), ::testing::HasSubstr("laser2"));
    EXPECT_THAT(error.what(), ::testing::HasSubstr("wraps every second"));
  }
}

TEST(CounterUnwrapper, CountsAcrossAGapOfSeveralWraps) {
  CounterUnwrapper counter;
  counter.accept(65530);
  EXPECT_EQ(counter.advance(4, 9.7), 10);
  EXPECT_EQ(counter.advance(4, 3 * 65536 + 200.0), 3 * 65536 + 10);
  EXPECT_EQ(counter.advance(65528, 1), -2);
}

}  // namespace
}  // namespace crisp
