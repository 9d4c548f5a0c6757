// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include <fstream>
#include <sstream>

#include <crisp/capture_reader.hpp>

#include "tests/support/shared_data.hpp"

namespace crisp {
namespace {

struct RealReading {
  std::vector<Scan> scans;
  CaptureStatistics statistics;
};

RealReading read(const std::filesystem::path& path) {
  RealReading reading;
  CaptureReader reader(path, default_rig());
  while (auto item = reader.next()) reading.scans.push_back(*std::get<std::shared_ptr<const Scan>>(*item));
  reading.statistics = reader.statistics();
  return reading;
}

TEST(RealCaptures, OfAnLms111HoldItsScansOnceAndNameWhatTcpSentAgain) {
  const auto path = shared_data() / "sick/lms111-20210302-colab-rebuilt.pcap";
  if (!std::filesystem::exists(path)) GTEST_SKIP() << "no shared data: " << path.filename();
  const auto reading = read(path);
  ASSERT_EQ(reading.scans.size(), 172U);
  for (std::size_t i = 0; i < reading.scans.size(); ++i) {
    EXPECT_EQ(reading.scans[i].scan_counter, 4 + i);
    EXPECT_EQ(reading.scans[i].serial_number, 18090362U);
    EXPECT_EQ(reading.scans[i].echoes.at(0).ranges.size(), 541U);
    EXPECT_EQ(reading.scans[i].device_status, i < 7 ? 1 : 0) << "until the motor is at speed";
  }
  const auto& laser = reading.statistics.devices.at(0);
  EXPECT_TRUE(laser.losses.all().empty());
  EXPECT_TRUE(reading.statistics.losses.all().empty());
  EXPECT_EQ(laser.notes.of("scans retransmitted by TCP"), 3U);
  EXPECT_EQ(laser.notes.of("retransmitted TCP segments"), 7U) << "of the 8, one is the hub's";
  EXPECT_NEAR(*laser.period, 20'114.5e-6, 34e-6);
  EXPECT_GT(*laser.median_handover, 3.07e-3);
  EXPECT_LT(*laser.median_handover, 3.27e-3);
  EXPECT_EQ(laser.period_hint(), -1) << "3 ms after its stamp no scan of 270° is over";
}

TEST(RealCaptures, OfATim781sGiveTheTimesThatAnIndependentReaderFound) {
  const auto path = shared_data() / "sick/tim781s-20210106-colab.pcapng";
  std::ifstream table(shared_data() / "clocks/sick_tim781_tcp.csv");
  if (!std::filesystem::exists(path) || !table) GTEST_SKIP() << "no shared data: " << path.filename();
  const auto reading = read(path);
  ASSERT_EQ(reading.scans.size(), 766U);
  EXPECT_TRUE(reading.statistics.devices.at(0).losses.all().empty());
  EXPECT_TRUE(reading.statistics.losses.all().empty());
  std::string line;
  std::getline(table, line);  // names of the columns
  std::size_t i = 0;
  for (; std::getline(table, line); ++i) {
    std::istringstream cells(line);
    std::int64_t scan = 0, telegram = 0, scan_us = 0, transmission_us = 0, first_ns = 0, last_ns = 0;
    char comma = 0;
    cells >> scan >> comma >> telegram >> comma >> scan_us >> comma >> transmission_us >> comma >> first_ns >>
        comma >> last_ns;
    ASSERT_EQ(reading.scans.at(i).scan_counter, scan);
    ASSERT_EQ(reading.scans[i].telegram_counter, telegram);
    ASSERT_EQ(reading.scans[i].scan_time_us, scan_us);
    ASSERT_EQ(reading.scans[i].transmission_time_us, transmission_us);
    ASSERT_EQ(reading.scans[i].receipt_ns, last_ns) << "the packet that completes the telegram";
    ASSERT_EQ(reading.scans[i].echoes.at(0).ranges.size(), 811U);
    ASSERT_EQ(reading.scans[i].echoes[0].remissions.size(), 811U);
  }
  EXPECT_EQ(i, 766U);
  EXPECT_NEAR(*reading.statistics.devices[0].skew, 4.1e-6, 0.5e-6)
      << "of the transmission times, found independently";
}

}  // namespace
}  // namespace crisp
