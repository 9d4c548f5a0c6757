// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/wire/scan_conversion.hpp"

#include <gmock/gmock.h>

#include <limits>

#include "pipeline/data/degree.hpp"

namespace crisp {
namespace {

using namespace crisp::data;
using namespace crisp::wire;
using testing::ElementsAre;
using testing::FloatEq;

ScanData data_with(std::vector<ChannelBlock> channels16, std::vector<ChannelBlock> channels8 = {}) {
  ScanData data;
  data.channels16 = std::move(channels16);
  data.channels8 = std::move(channels8);
  for (auto* channels : {&data.channels16, &data.channels8}) {
    for (auto& channel : *channels) {
      channel.start_angle = -450000;
      channel.angle_step = 5000;
    }
  }
  return data;
}

TEST(ScanConversion, GivesMetresAndRadians) {
  auto data = data_with({{.name = "DIST1", .raw = {1234, 20000}}});
  data.scan_frequency = 2500;
  data.serial_number = 4711;
  data.scan_time_us = 1;
  data.transmission_time_us = 2;
  data.telegram_counter = 3;
  data.scan_counter = 4;
  data.device_status = 5;
  data.encoders = {{6, -7}};
  Scan scan;
  ASSERT_EQ(to_scan(data, 2, 99, scan), ScanFailure::None);
  EXPECT_THAT(scan.echoes.at(0).ranges, ElementsAre(FloatEq(1.234F), FloatEq(20.0F)));
  EXPECT_TRUE(scan.echoes.at(0).remissions.empty());
  EXPECT_DOUBLE_EQ(scan.start_angle, -45 * kDegree);
  EXPECT_DOUBLE_EQ(scan.angle_step, 0.5 * kDegree);
  EXPECT_EQ(scan.scan_frequency, 25);
  EXPECT_EQ(scan.laser, 2);
  EXPECT_EQ(scan.receipt_ns, 99);
  EXPECT_EQ(scan.serial_number, 4711U);
  EXPECT_EQ(scan.scan_time_us, 1U);
  EXPECT_EQ(scan.transmission_time_us, 2U);
  EXPECT_EQ(scan.telegram_counter, 3);
  EXPECT_EQ(scan.scan_counter, 4);
  EXPECT_EQ(scan.device_status, 5);
  ASSERT_EQ(scan.encoders.size(), 1U);
  EXPECT_EQ(scan.encoders[0].position, 6U);
  EXPECT_EQ(scan.encoders[0].speed, -7);
}

TEST(ScanConversion, TakesCodesBelow16ForNoRange) {
  Scan scan;
  ASSERT_EQ(to_scan(data_with({{.raw = {0, 2, 3, 15, 16}}}), 0, 0, scan), ScanFailure::None);
  EXPECT_THAT(scan.echoes.at(0).ranges, ElementsAre(0, 0, 0, 0, FloatEq(0.016F)));
  ASSERT_EQ(to_scan(data_with({{.scale = 2, .offset = 1000, .raw = {15, 16}}}), 0, 0, scan),
            ScanFailure::None);
  EXPECT_THAT(scan.echoes.at(0).ranges, ElementsAre(0, FloatEq(1.032F)));
  ASSERT_EQ(to_scan(data_with({{.offset = -100, .raw = {50, 150}}}), 0, 0, scan), ScanFailure::None);
  EXPECT_THAT(scan.echoes.at(0).ranges, ElementsAre(0, FloatEq(0.05F))) << "never a negative range";
}

TEST(ScanConversion, PutsEachChannelIntoItsEcho) {
  Scan scan;
  const auto data = data_with(
      {{.name = "DIST1", .raw = {100, 200}},
       {.name = "DIST2", .raw = {300, 400}},
       {.name = "ANGL1", .raw = {1}}},
      {{.name = "RSSI1", .scale = 2, .offset = 1, .raw = {5, 6}}, {.name = "RSSI2", .raw = {7, 8}}});
  ASSERT_EQ(to_scan(data, 0, 0, scan), ScanFailure::None);
  ASSERT_EQ(scan.echoes.size(), 2U);
  EXPECT_THAT(scan.echoes[0].ranges, ElementsAre(FloatEq(0.1F), FloatEq(0.2F)));
  EXPECT_THAT(scan.echoes[1].ranges, ElementsAre(FloatEq(0.3F), FloatEq(0.4F)));
  EXPECT_THAT(scan.echoes[0].remissions, ElementsAre(11, 13));
  EXPECT_THAT(scan.echoes[1].remissions, ElementsAre(7, 8));
}

TEST(ScanConversion, LeavesNothingOfTheScanBeforeInReusedMemory) {
  Scan scan;
  ASSERT_EQ(to_scan(data_with({{.name = "DIST1", .raw = {100, 200}}, {.name = "DIST2", .raw = {300, 400}}},
                              {{.name = "RSSI1", .raw = {5, 6}}}),
                    0, 0, scan),
            ScanFailure::None);
  ASSERT_EQ(to_scan(data_with({{.raw = {500}}}), 0, 0, scan), ScanFailure::None);
  ASSERT_EQ(scan.echoes.size(), 1U);
  EXPECT_THAT(scan.echoes[0].ranges, ElementsAre(FloatEq(0.5F)));
  EXPECT_TRUE(scan.echoes[0].remissions.empty());
}

TEST(ScanConversion, RestoresTheFractionThatADeviceRounds) {
  EXPECT_DOUBLE_EQ(exact_angle_step(3333), kDegree / 3);
  EXPECT_DOUBLE_EQ(exact_angle_step(1667), kDegree / 6);
  EXPECT_DOUBLE_EQ(exact_angle_step(6667), kDegree * 2 / 3);
  EXPECT_DOUBLE_EQ(exact_angle_step(833), kDegree / 12);
  EXPECT_DOUBLE_EQ(exact_angle_step(417), kDegree / 24);
  EXPECT_DOUBLE_EQ(exact_angle_step(2500), kDegree / 4);
  EXPECT_DOUBLE_EQ(exact_angle_step(5000), kDegree / 2);
  EXPECT_DOUBLE_EQ(exact_angle_step(1000), kDegree / 10);
  EXPECT_DOUBLE_EQ(exact_angle_step(10000), kDegree);
}

TEST(ScanConversion, RefusesTelegramsThatMakeNoScan) {
  Scan scan;
  EXPECT_EQ(to_scan(data_with({}), 0, 0, scan), ScanFailure::NoDistances);
  EXPECT_EQ(to_scan(data_with({{.name = "RSSI1", .raw = {1}}}), 0, 0, scan), ScanFailure::NoDistances);
  EXPECT_EQ(to_scan(data_with({{.raw = {100, 200}}, {.name = "RSSI1", .raw = {1}}}), 0, 0, scan),
            ScanFailure::ChannelsDisagree);
  EXPECT_EQ(
      to_scan(data_with({{.scale = std::numeric_limits<float>::quiet_NaN(), .raw = {100}}}), 0, 0, scan),
      ScanFailure::BadScale);
  EXPECT_EQ(
      to_scan(data_with({{.offset = std::numeric_limits<float>::infinity(), .raw = {100}}}), 0, 0, scan),
      ScanFailure::BadScale);
  EXPECT_EQ(to_scan(data_with({{.raw = std::vector<std::uint16_t>(800, 100)}}), 0, 0, scan),
            ScanFailure::BadAngles);
  ScanData without_step = data_with({{.raw = {100, 200}}});
  without_step.channels16[0].angle_step = 0;
  EXPECT_EQ(to_scan(without_step, 0, 0, scan), ScanFailure::BadAngles);
}

}  // namespace
}  // namespace crisp
