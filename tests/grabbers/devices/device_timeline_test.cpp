// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/devices/device_timeline.hpp"

#include <gtest/gtest.h>

namespace crisp {
namespace {

using namespace crisp::clocks;
using namespace crisp::devices;

constexpr std::int64_t kInterval_us = 20'000;

/// Item k of a device that has sent 50 a second since its clock began.
DeviceTimeline::Item item(std::int64_t k, double delay = 0) {
  const std::int64_t sent_us = kInterval_us * k;
  return {.counter = static_cast<std::uint16_t>(k),
          .stamp = {.receipt_ns = 1000 * sent_us + static_cast<std::int64_t>(1e9 * delay),
                    .device_us = static_cast<std::uint32_t>(sent_us)}};
}

/// Judges an item and passes it on if it is new.
DeviceTimeline::Arrival come(DeviceTimeline& timeline, const DeviceTimeline::Item& next) {
  const auto arrival = timeline.judge(next);
  if (arrival.is_new) timeline.pass_on(next.stamp);
  return arrival;
}

DeviceStatistics statistics_of(const DeviceTimeline& timeline) {
  DeviceStatistics statistics;
  timeline.add_to(statistics, kTelegramsNeverCame);
  return statistics;
}

TEST(DeviceTimeline, CountsLossesRepeatsAndLateItems) {
  DeviceTimeline timeline(nullptr);
  for (const std::int64_t k : {0, 1, 2, 4, 3, 4, 8}) {
    const auto arrival = come(timeline, item(k));
    EXPECT_FALSE(arrival.begins_anew) << k;
  }
  const auto found = statistics_of(timeline);
  EXPECT_EQ(found.items, 6U) << "the second item 4 came before";
  EXPECT_EQ(found.losses.of(kTelegramsNeverCame), 3U) << "5 to 7; item 3 came late";
  EXPECT_EQ(found.notes.of("items that came late"), 1U);
  EXPECT_EQ(found.notes.of("items that came twice"), 1U);
}

TEST(DeviceTimeline, AStepOfTheHubsClockIsNoSilence) {
  DeviceTimeline stepped(nullptr), silent(nullptr);
  for (std::int64_t k = 0; k < 100; ++k) {
    come(stepped, item(k, k < 50 ? 0 : 3.7));
    if (k < 30 || k >= 90) come(silent, item(k));
  }
  EXPECT_NEAR(statistics_of(stepped).longest_silence, 0.02, 1e-9);
  EXPECT_NEAR(statistics_of(silent).longest_silence, 61 * 0.02, 1e-9);
}

TEST(DeviceTimeline, NotesReceiptsThatJump) {
  const auto jumps = [](const DeviceTimeline& timeline) {
    const DeviceStatistics statistics = statistics_of(timeline);
    std::uint64_t sum = 0;
    for (const auto& [what, n] : statistics.notes.all()) sum += what.starts_with("receipts") ? n : 0;
    return sum;
  };
  DeviceTimeline ahead(nullptr), back(nullptr), silent(nullptr), reset(nullptr);
  for (std::int64_t k = 0; k < 100; ++k) {
    come(ahead, item(k, k < 50 ? 0 : 3.7));
    come(back, item(k, k < 50 ? 0 : -0.8));
    if (k < 30 || k >= 90) come(silent, item(k));
    auto restarted = item(k);
    if (k >= 50) restarted.stamp.device_us -= 50 * kInterval_us;
    come(reset, restarted);
  }
  EXPECT_EQ(jumps(ahead), 1U);
  EXPECT_EQ(jumps(back), 1U);
  EXPECT_EQ(jumps(silent), 0U);
  EXPECT_EQ(jumps(reset), 0U);
}

TEST(DeviceTimeline, CountsNoLossesOfAPollingClient) {
  DeviceTimeline timeline(nullptr);
  for (const std::int64_t k : {0, 5, 5, 10}) {
    auto polled = item(k);
    polled.is_polled = true;
    come(timeline, polled);
  }
  const auto found = statistics_of(timeline);
  EXPECT_TRUE(found.losses.all().empty());
  EXPECT_EQ(found.notes.of("scans between the requested ones"), 8U);
  EXPECT_EQ(found.notes.of("scans read twice by a client"), 1U);
}

TEST(DeviceTimeline, BeginsAnewWhereTheClockWasReset) {
  DeviceTimeline timeline(nullptr);
  for (std::int64_t k = 0; k < 100; ++k) come(timeline, item(k));
  auto after = item(3);
  after.stamp.receipt_ns = item(500).stamp.receipt_ns;
  EXPECT_TRUE(come(timeline, after).begins_anew);
  const auto found = statistics_of(timeline);
  EXPECT_EQ(found.notes.of("restarts of the device's clock"), 1U);
  EXPECT_TRUE(found.losses.all().empty()) << "a counter that begins anew lost nothing";
  EXPECT_NEAR(found.longest_silence, 401 * 0.02, 1e-9);
  EXPECT_EQ(found.silence_ns, item(99).stamp.receipt_ns);
}

TEST(DeviceTimeline, TakesAPauseOfAllDevicesForNoLoss) {
  Pauses pauses;
  DeviceTimeline one(&pauses);
  DeviceTimeline other(&pauses);
  for (const std::int64_t k : {0, 1, 2, 1000, 1001}) {
    EXPECT_EQ(come(one, item(k)).begins_anew, k == 1000);
    EXPECT_EQ(come(other, item(k, 0.001)).begins_anew, k == 1000) << "the pause is that of all devices";
  }
  for (const auto* timeline : {&one, &other}) {
    const auto found = statistics_of(*timeline);
    EXPECT_EQ(found.pauses, 1U);
    EXPECT_EQ(found.paused_ns, 998 * 1000 * kInterval_us);
    EXPECT_TRUE(found.losses.all().empty());
    EXPECT_TRUE(found.notes.all().empty()) << "no reset";
  }
  EXPECT_EQ(pauses.count(), 1U);
}

TEST(DeviceTimeline, TakesASilenceOfOneDeviceForALoss) {
  Pauses pauses;
  DeviceTimeline speaks(&pauses);
  DeviceTimeline silent(&pauses);
  for (std::int64_t k = 0; k < 1000; ++k) {
    come(speaks, item(k));
    if (k >= 100 && k < 900) continue;
    EXPECT_FALSE(come(silent, item(k, 0.001)).begins_anew);
  }
  EXPECT_EQ(statistics_of(silent).losses.of(kTelegramsNeverCame), 800U);
  EXPECT_EQ(pauses.count(), 0U);
}

TEST(DeviceTimeline, CountsItemsThatCarryTheStampBeforeThem) {
  DeviceTimeline timeline(nullptr);
  for (std::int64_t k = 0; k < 5; ++k) {
    auto standing = item(k);
    standing.stamp.device_us = 7;
    come(timeline, standing);
  }
  EXPECT_EQ(statistics_of(timeline).standing, 4U);
}

}  // namespace
}  // namespace crisp
