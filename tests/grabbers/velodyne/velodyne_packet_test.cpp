// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/velodyne/velodyne_packet.hpp"

#include <gtest/gtest.h>

#include <numbers>
#include <vector>

namespace crisp {
namespace {

using namespace crisp::velodyne;

/// A packet as the manual draws it: block b at azimuth 100 + 40 b hundredths of a degree; laser 3 of the
/// second firing of block 5 sees 1000 steps of 2 mm with intensity 77.
std::vector<std::uint8_t> sample() {
  std::vector<std::uint8_t> bytes(kVelodynePacket, 0);
  for (std::size_t b = 0; b < kVelodyneBlocks; ++b) {
    bytes[100 * b] = 0xFF;
    bytes[100 * b + 1] = 0xEE;
    const std::size_t azimuth = 100 + 40 * b;
    bytes[100 * b + 2] = static_cast<std::uint8_t>(azimuth % 256);
    bytes[100 * b + 3] = static_cast<std::uint8_t>(azimuth / 256);
  }
  const std::size_t at = 5 * 100 + 4 + (16 + 3) * 3;
  bytes[at] = 1000 % 256;
  bytes[at + 1] = 1000 / 256;
  bytes[at + 2] = 77;
  bytes[1200] = 0x40;  // 1 000 000 µs past the hour
  bytes[1201] = 0x42;
  bytes[1202] = 0x0F;
  bytes[1204] = 0x37;
  bytes[1205] = 0x22;
  return bytes;
}

TEST(VelodynePacket, HasTimeAzimuthsAndReturnsWhereTheManualPutsThem) {
  const auto packet = parse_velodyne(sample());
  ASSERT_TRUE(packet);
  EXPECT_EQ(packet->time_us, 1'000'000U);
  EXPECT_NEAR(packet->azimuth[11], 5.4 / 180 * std::numbers::pi, 1e-12);
  EXPECT_FLOAT_EQ(packet->returns[5][1][3].range, 2.0F);
  EXPECT_EQ(packet->returns[5][1][3].intensity, 77);
  EXPECT_EQ(packet->returns[5][0][3].range, 0);
}

TEST(VelodynePacket, ShotsFollowOneAnotherAsInTheManual) {
  EXPECT_NEAR(velodyne_shot(0, 0, 15), 34.56e-6, 1e-12);
  EXPECT_NEAR(velodyne_shot(11, 1, 15), 1306.368e-6, 1e-10);
}

TEST(VelodynePacket, TimeGoesOnOverSilencesAndTheFullHour) {
  EXPECT_EQ(velodyne_passed_us(5, 5), 0U);
  EXPECT_EQ(velodyne_passed_us(0, 1'000'000'000), 1'000'000'000U);
  EXPECT_EQ(velodyne_passed_us(3'599'000'000, 1'000'000), 2'000'000U);
  EXPECT_EQ(velodyne_passed_us(1'000'000, 0), 3'599'000'000U);
}

TEST(VelodynePacket, OfAnotherKindIsNone) {
  for (const auto& [at, value] : {std::pair{std::size_t{0}, 0xFE},
                                  {std::size_t{1204}, 0x39},
                                  {std::size_t{1205}, 0x21},
                                  {std::size_t{103}, 0xFF},
                                  {std::size_t{1203}, 0xFF}}) {
    auto bytes = sample();
    bytes[at] = static_cast<std::uint8_t>(value);
    EXPECT_FALSE(parse_velodyne(bytes)) << at;
  }
  auto bytes = sample();
  bytes.pop_back();
  EXPECT_FALSE(parse_velodyne(bytes));
  EXPECT_FALSE(parse_velodyne({}));
}

}  // namespace
}  // namespace crisp
