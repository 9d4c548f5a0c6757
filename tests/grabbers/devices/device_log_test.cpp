// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/devices/device_log.hpp"

#include <gmock/gmock.h>

#include "tests/grabbers/capture/capture_bytes.hpp"

namespace crisp {
namespace {

using namespace crisp::devices;
using namespace crisp::wire;

/// The payload of a framed CoLa-B telegram: between start and length, and the checksum.
ByteView payload_of(const Bytes& telegram) { return ByteView(telegram).subspan(8, telegram.size() - 9); }

TEST(DeviceLog, ReadsTheUprightLayerOnlyAndCountsTilted) {
  constexpr std::uint16_t kTurns = 5;
  DeviceLog log(DeviceKind::Laser, "laser1", kLaser1);
  std::uint16_t telegrams = 0;
  std::size_t scans = 0;
  for (std::uint16_t turn = 0; turn < kTurns; ++turn) {
    for (const int elevation : {500, 0, -500, -1000}) {
      ScanData data = numbered_scan(turn);
      data.layer = static_cast<std::uint16_t>(elevation);
      data.telegram_counter = telegrams++;
      const Bytes telegram = encode_scan_data(data, ColaLanguage::B);
      const auto scan = log.take({.payload = payload_of(telegram), .completed_ns = kStart + turn},
                                 EncoderWidths::Position32);
      EXPECT_EQ(scan != nullptr, elevation == 0);
      scans += scan ? 1 : 0;
    }
  }
  EXPECT_EQ(scans, kTurns);
  const auto losses = log.statistics().losses.all();
  ASSERT_EQ(losses.size(), 1U);  // and no telegram counts as missing
  EXPECT_THAT(losses.begin()->first, testing::HasSubstr("tilted layer"));
  EXPECT_EQ(losses.begin()->second, 3U * kTurns);
}

/// Sends every `every`th scan of a laser, each some times, as answers to a client that polls.
DeviceStatistics polled(int every, int times) {
  DeviceLog log(DeviceKind::Laser, "laser1", kLaser1);
  for (int k = 0; k < 200; k += every) {
    ScanData data = numbered_scan(static_cast<std::uint16_t>(65'300 + k));
    Bytes telegram;
    append_scan_data(data, ColaLanguage::B, "sRA", EncoderWidths::Position32, telegram);
    for (int i = 0; i < times; ++i) {
      const auto scan =
          log.take({.payload = payload_of(telegram), .completed_ns = kStart + k * 20'000'000LL + i},
                   EncoderWidths::Position32);
      EXPECT_EQ(scan != nullptr, i == 0);
      EXPECT_FALSE(scan && scan->numbered) << "a gap of its numbers is no loss";
    }
  }
  return log.statistics();
}

TEST(DeviceLog, MissesNothingThatAClientWhichPollsDidNotRequest) {
  const auto statistics = polled(2, 1);
  EXPECT_EQ(statistics.items, 100U);
  EXPECT_TRUE(statistics.losses.all().empty());
  EXPECT_EQ(statistics.notes.of("scans between the requested ones"), 99U);
}

TEST(DeviceLog, CountsScansThatAClientReadTwice) {
  const auto statistics = polled(1, 3);
  EXPECT_EQ(statistics.items, 200U);
  EXPECT_TRUE(statistics.losses.all().empty());
  EXPECT_EQ(statistics.notes.of("scans read twice by a client"), 400U);
  EXPECT_EQ(statistics.standing, 0U);
}

TEST(DeviceLog, CountsStampsThatNeverMove) {
  DeviceLog log(DeviceKind::Plate, "plate", kPlate);
  for (std::uint16_t k = 0; k < 100; ++k) {
    PlateReading reading = numbered_reading(k);
    reading.device_us = 0;
    reading.receipt_ns = kStart + k * 2'000'000LL;
    EXPECT_TRUE(log.take(reading)) << "its count moves";
  }
  EXPECT_EQ(log.statistics().standing, 99U);
  EXPECT_TRUE(log.statistics().losses.all().empty());
}

}  // namespace
}  // namespace crisp
