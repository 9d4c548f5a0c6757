// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/capture/device_log.hpp"

#include <gmock/gmock.h>

#include "tests/grabbers/capture/capture_bytes.hpp"

namespace crisp {
namespace {

/// The payload of a framed CoLa-B telegram: between start and length, and the checksum.
ByteView payload_of(const Bytes& telegram) {
  return ByteView(telegram).subspan(8, telegram.size() - 9);
}

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

}  // namespace
}  // namespace crisp
