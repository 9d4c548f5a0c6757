// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>

#include "grabbers/wire/scan_conversion.hpp"
#include "plugins/clock/scan_timestamper.hpp"
#include "tests/grabbers/wire/samples.hpp"

namespace crisp {
namespace {

using namespace crisp::clock;
using namespace crisp::wire;
using ::testing::HasSubstr;

/// What alignment makes of one laser's recorded dialogue.
struct Timed {
  DeviceReport report;
  std::string warning;
  std::vector<TimedScan> scans;
  double mean_period = 0;    ///< [s]
  double period_spread = 0;  ///< [s] standard deviation
};

Timed align_dialogue(const std::string& name) {
  const RigLaser laser{.name = "real"};
  ScanTimestamper track(laser, DeviceStamps("real", WindowedClockFit("real", 5e-8), 0), TimeSource::clock, 0);
  std::ifstream file(shared_data() / "sick" / name);
  for (const auto& entry : nlohmann::json::parse(file)) {
    const auto& tcp = entry.at("_source").at("layers").at("tcp");
    const double seconds = std::stod(tcp.at("Timestamps").at("tcp.time_relative").get<std::string>());
    for (const auto& found : find_telegrams(from_hex(tcp.at("tcp.payload").get<std::string>()))) {
      const auto telegram = parse_cola(found.payload, found.language);
      if (!telegram || telegram->name != kScanDataName || telegram->command != "sSN") continue;
      ScanData data;
      decode_scan_data(*telegram, EncoderWidths::Position32, data);
      auto scan = std::make_shared<Scan>();
      to_scan(data, 0, std::llround(1e9 * seconds), *scan);
      track.add(scan, seconds);
    }
  }
  track.clock().settle(0, 1000);
  track.clock().finish();
  Timed timed{.report = track.report(), .warning = track.stamp_warning(), .scans = {}};
  track.take_before(std::numeric_limits<double>::infinity(), timed.scans);
  const auto n = static_cast<double>(timed.scans.size());
  for (const auto& scan : timed.scans) timed.mean_period += scan.period / n;
  for (const auto& scan : timed.scans) {
    timed.period_spread += std::pow(scan.period - timed.mean_period, 2) / n;
  }
  timed.period_spread = std::sqrt(timed.period_spread);
  return timed;
}

bool missing(const std::string& name) { return !std::filesystem::exists(shared_data() / "sick" / name); }

TEST(RealLasers, AnLms111TurnsSlowlyAndStampsATurnLate) {
  const std::string name = "lms111-20210302-colab.json";
  if (missing(name)) GTEST_SKIP() << "no shared data: " << name;
  const auto timed = align_dialogue(name);
  EXPECT_EQ(timed.report.stamps, 172u);
  EXPECT_EQ(timed.report.repeated, 3u);  // retransmitted
  EXPECT_EQ(timed.report.lost, 0u);
  EXPECT_EQ(timed.report.resets, 0u);
  // An independent evaluation: 11 +- 8 ppm; delays 68 us in the median, 345 us at 95 %; periods 20114.5 +- 34
  // us.
  EXPECT_NEAR(timed.report.clock->skew_ppm(), 11, 8);
  EXPECT_NEAR(timed.report.clock->residual_median, 68e-6, 15e-6);
  EXPECT_NEAR(timed.report.clock->residual_95, 345e-6, 40e-6);
  EXPECT_NEAR(timed.mean_period, 20114.5e-6, 3e-6);
  EXPECT_NEAR(timed.period_spread, 25e-6,
              8e-6);  // the stamps' own scatter is in the 34 us, but not in the motion
  EXPECT_THAT(timed.warning, HasSubstr("period_offset: -1"));
  for (std::size_t i = 8; i < timed.scans.size(); ++i) {  // from when the motor was at speed
    const double step = timed.scans[i].begin - timed.scans[i - 1].begin;
    EXPECT_NEAR(step, 0.5 * (timed.scans[i].period + timed.scans[i - 1].period), 15e-6) << i;
  }
}

TEST(RealLasers, AnLms511KeepsItsRateAndStampsInTime) {
  for (const std::string name : {"lms511-20210301-colab.json", "lms511-20210302-colab.json"}) {
    if (missing(name)) GTEST_SKIP() << "no shared data: " << name;
    const auto timed = align_dialogue(name);
    EXPECT_NEAR(timed.mean_period, 40001e-6, 3e-6);
    EXPECT_EQ(timed.report.lost, 0u);
    // An independent evaluation: 3 +- 9 and 7 +- 4 ppm, delays of 44 to 63 us in the median, 127 to 190 at 95
    // %.
    const double error = 1e6 * timed.report.clock->skew_std_error;
    EXPECT_LT(error, 15);
    EXPECT_NEAR(timed.report.clock->skew_ppm(), 5, 3 * error);
    EXPECT_NEAR(timed.report.clock->residual_median, 54e-6, 15e-6);
    EXPECT_NEAR(timed.report.clock->residual_95, 159e-6, 40e-6);
    EXPECT_EQ(timed.warning, "");
  }
}

}  // namespace
}  // namespace crisp
