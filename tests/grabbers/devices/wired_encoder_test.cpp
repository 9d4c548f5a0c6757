// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/devices/wired_encoder.hpp"

#include <gmock/gmock.h>

namespace crisp {
namespace {

using namespace crisp::devices;
using testing::ElementsAre;

Rig rig_with_encoder_of(std::uint16_t laser) {
  Rig rig = default_rig();
  rig.plate.address = {};
  rig.plate.encoder_of = laser;
  return rig;
}

Scan scan_of(std::uint16_t laser, std::uint16_t k, std::vector<ScanEncoder> encoders) {
  Scan scan{.laser = laser, .telegram_counter = k, .scan_time_us = 40'000U * k};
  scan.transmission_time_us = scan.scan_time_us + 4000;
  scan.receipt_ns = 1'700'000'000'000'000'000 + k * 40'000'000LL;
  scan.encoders = std::move(encoders);
  return scan;
}

std::vector<std::uint32_t> counts_of(const std::vector<std::uint32_t>& positions, EncoderWidths widths) {
  WiredEncoder encoder(rig_with_encoder_of(1));
  std::vector<std::uint32_t> counts;
  std::uint16_t k = 0;
  for (const std::uint32_t position : positions)
    counts.push_back(encoder.read(scan_of(1, k++, {{.position = position}}), widths)->count);
  return counts;
}

TEST(WiredEncoder, ReadsAScansCountAtItsStampOnTheLasersClock) {
  WiredEncoder encoder(rig_with_encoder_of(1));
  const auto reading =
      encoder.read(scan_of(1, 7, {{.position = 1234}, {.position = 99}}), EncoderWidths::Position32);
  ASSERT_TRUE(reading);
  EXPECT_EQ(reading->count, 1234U);
  EXPECT_EQ(reading->sequence, 7);
  EXPECT_EQ(reading->device_us, 280'000U);
  EXPECT_EQ(reading->handover_us, 4000);
  EXPECT_EQ(reading->receipt_ns, 1'700'000'000'280'000'000);
  EXPECT_FALSE(encoder.read(scan_of(0, 8, {{.position = 5}}), EncoderWidths::Position32))
      << "of another laser";
}

TEST(WiredEncoder, KeepsA32BitCountAsItIsSoThatMinusOneFollowsZero) {
  EXPECT_THAT(counts_of({1, 0, 4294967295U}, EncoderWidths::Position32), ElementsAre(1U, 0U, 4294967295U));
}

TEST(WiredEncoder, ContinuesA16BitCountAcrossItsWrapsInEitherDirection) {
  EXPECT_THAT(counts_of({65000, 400, 30000, 60000, 24464}, EncoderWidths::Position16),
              ElementsAre(65000U, 65936U, 95536U, 125536U, 155536U));
  EXPECT_THAT(counts_of({100, 65000}, EncoderWidths::Position16), ElementsAre(100U, 4294966760U));
}

TEST(WiredEncoder, CountsScansThatHaveNone) {
  WiredEncoder encoder(rig_with_encoder_of(1));
  EXPECT_FALSE(encoder.read(scan_of(1, 0, {}), EncoderWidths::Position32));
  EXPECT_TRUE(encoder.read(scan_of(1, 1, {{.position = 3}}), EncoderWidths::Position32));
  EXPECT_TRUE(encoder.read(scan_of(1, 2, {{.position = 4294967293U}}), EncoderWidths::Position32));
  const DeviceStatistics statistics = encoder.statistics();
  EXPECT_EQ(statistics.kind, DeviceKind::Plate);
  EXPECT_EQ(statistics.items, 2U);
  EXPECT_EQ(statistics.counted_down, 6U);
  EXPECT_EQ(statistics.losses.of("scans without the encoder's count"), 1U);
}

}  // namespace
}  // namespace crisp
