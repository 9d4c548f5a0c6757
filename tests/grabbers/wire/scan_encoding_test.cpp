// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/wire/scan_encoding.hpp"

#include <gtest/gtest.h>

#include <limits>

#include <crisp/error.hpp>

#include "grabbers/wire/scan_conversion.hpp"

namespace crisp {
namespace {

using namespace crisp::wire;

Scan decoded(const ScanData& data) {
  Scan scan;
  EXPECT_EQ(to_scan(data, 2, 77, scan), ScanFailure::None);
  return scan;
}

ScanData telegram() {
  ScanData data{.serial_number = 4711, .device_status = 2, .telegram_counter = 65535, .scan_counter = 9};
  data.scan_time_us = 4294967295;
  data.transmission_time_us = 12;
  data.encoders = {{17, -3}};
  data.channels16 = {
      {.name = "DIST1", .start_angle = -450000, .angle_step = 1667, .raw = {1000, 0, 65535, 16}},
      {.name = "DIST2", .start_angle = -450000, .angle_step = 1667, .raw = {2000, 20, 0, 17}}};
  data.channels8 = {{.name = "RSSI1", .start_angle = -450000, .angle_step = 1667, .raw = {254, 0, 7, 1}}};
  return data;
}

TEST(ScanEncoding, GivesTheTelegramBackThatAScanWasDecodedFrom) {
  const ScanData data = telegram();
  EXPECT_EQ(to_scan_data(decoded(data)), data);
}

TEST(ScanEncoding, EncodesRangesBeyond65MetresInCoarserUnits) {
  ScanData data = telegram();
  data.channels16[0].scale = 2;  // as an LMS5xx does
  data.channels16[0].raw = {1000, 0, 40000, 16};
  const ScanData again = to_scan_data(decoded(data));
  EXPECT_EQ(again.channels16[0].scale, 2);
  EXPECT_EQ(again.channels16[0].raw, data.channels16[0].raw);
}

TEST(ScanEncoding, EncodesRemissionsOf16Bits) {
  ScanData data = telegram();
  data.channels8.clear();
  data.channels16 = {
      data.channels16[0],
      {.name = "RSSI1", .start_angle = -450000, .angle_step = 1667, .raw = {65535, 0, 700, 1}}};
  EXPECT_EQ(to_scan_data(decoded(data)), data);
}

TEST(ScanEncoding, RefusesScansThatATelegramCannotEncode) {
  Scan scan = decoded(telegram());
  scan.echoes[0].ranges[0] = std::numeric_limits<float>::infinity();
  EXPECT_THROW(to_scan_data(scan), Error);
  scan = decoded(telegram());
  scan.angle_step = 1;
  EXPECT_THROW(to_scan_data(scan), Error);
  for (const float remission : {-20.0F, std::numeric_limits<float>::quiet_NaN()}) {
    scan = decoded(telegram());
    scan.echoes[0].remissions[0] = remission;
    EXPECT_THROW(to_scan_data(scan), Error) << remission;
  }
  scan = decoded(telegram());
  scan.echoes.resize(1);
  scan.echoes[0] = {.ranges = std::vector<float>(20'000, 1.0F)};
  EXPECT_THROW(to_scan_data(scan), Error);
}

}  // namespace
}  // namespace crisp
