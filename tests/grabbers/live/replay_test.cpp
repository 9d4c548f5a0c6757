// SPDX-License-Identifier: BSD-3-Clause
// Real captures and dialogues, over loopback, to the live source.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <boost/asio/read.hpp>
#include <boost/asio/write.hpp>
#include <fstream>
#include <map>
#include <set>
#include <sstream>

#include <crisp/capture_reader.hpp>

#include "grabbers/emulate/emulator.hpp"
#include "plugins/clock/scan_timestamper.hpp"
#include "tests/grabbers/live/live_support.hpp"
#include "tests/grabbers/live/recorded_dialogue.hpp"
#include "tests/grabbers/wire/samples.hpp"

namespace crisp {
namespace {

using namespace crisp::clock;
using namespace crisp::emulate;
using namespace crisp::live;
using namespace crisp::wire;
namespace fs = std::filesystem;

void expect_same(const Scan& a, const Scan& b) {
  EXPECT_EQ(a.serial_number, b.serial_number);
  EXPECT_EQ(a.device_status, b.device_status);
  EXPECT_EQ(a.telegram_counter, b.telegram_counter);
  EXPECT_EQ(a.scan_counter, b.scan_counter);
  EXPECT_EQ(a.scan_time_us, b.scan_time_us);
  EXPECT_EQ(a.transmission_time_us, b.transmission_time_us);
  EXPECT_EQ(a.scan_frequency, b.scan_frequency);
  EXPECT_EQ(a.start_angle, b.start_angle);
  EXPECT_EQ(a.angle_step, b.angle_step);
  ASSERT_EQ(a.echoes.size(), b.echoes.size());
  for (std::size_t i = 0; i < a.echoes.size(); ++i) {
    EXPECT_EQ(a.echoes[i].ranges, b.echoes[i].ranges);
    EXPECT_EQ(a.echoes[i].remissions, b.echoes[i].remissions);
  }
}

std::vector<std::shared_ptr<const Scan>> read_offline(const fs::path& capture) {
  CaptureReader reader(capture, default_rig());
  std::vector<std::shared_ptr<const Scan>> scans;
  while (auto item = reader.next()) scans.push_back(std::get<std::shared_ptr<const Scan>>(*item));
  return scans;
}

/// Sends each scan through an emulated laser at its recorded hub time.
std::vector<std::shared_ptr<const Scan>> replay(const std::vector<std::shared_ptr<const Scan>>& scans,
                                                ColaLanguage language) {
  test::VirtualClock clock;
  Emulator emulator(test::loopback_rig(1), {.speed = 0});
  LiveSource source(
      emulator.rig(),
      {.plate = false, .sick = {.language = language, .silence = 600}, .clock = clock.reader()});
  std::vector<std::shared_ptr<const Scan>> live;
  for (const auto& scan : scans) {
    clock.ns = scan->receipt_ns;
    emulator.send(scan, [] { return false; });
    auto item = source.next_within(test::kPatience);
    if (!item) break;
    live.push_back(std::get<std::shared_ptr<const Scan>>(*item));
  }
  EXPECT_THAT(source.close().devices.at(0).losses.all(), testing::Each(testing::Pair(testing::_, 0)));
  return live;
}

DeviceReport align(const std::vector<std::shared_ptr<const Scan>>& scans) {
  ScanTimestamper track(RigLaser{.name = "real"}, DeviceStamps("real", WindowedClockFit("real", 5e-8), 0),
                        TimeSource::clock, 0);
  for (const auto& scan : scans) {
    track.add(scan, 1e-9 * static_cast<double>(scan->receipt_ns - scans.front()->receipt_ns));
  }
  track.clock().settle(0, 1000);
  track.clock().finish();
  return track.report();
}

class Replay : public testing::TestWithParam<ColaLanguage> {};

TEST_P(Replay, OfAnLms111GivesScanForScanWhatTheOfflineReaderGives) {
  const auto path = shared_data() / "sick/lms111-20210302-colab-rebuilt.pcap";
  if (!fs::exists(path)) GTEST_SKIP() << "no shared data: " << path.filename();
  const auto offline = read_offline(path);
  ASSERT_EQ(offline.size(), 172U);
  const auto live = replay(offline, GetParam());
  ASSERT_EQ(live.size(), offline.size());
  for (std::size_t i = 0; i < live.size(); ++i) {
    expect_same(*live[i], *offline[i]);
    EXPECT_EQ(live[i]->receipt_ns, offline[i]->receipt_ns);
  }
}

TEST_P(Replay, OfATim781sKeepsItsSkewAndJitter) {
  const auto path = shared_data() / "sick/tim781s-20210106-colab.pcapng";
  if (!fs::exists(path)) GTEST_SKIP() << "no shared data: " << path.filename();
  const auto offline = read_offline(path);
  ASSERT_EQ(offline.size(), 766U);
  const auto live = replay(offline, GetParam());
  ASSERT_EQ(live.size(), offline.size());
  for (std::size_t i = 0; i < live.size(); ++i) {
    expect_same(*live[i], *offline[i]);
    EXPECT_EQ(live[i]->receipt_ns, offline[i]->receipt_ns);
  }
  EXPECT_NEAR(align(live).clock->skew_ppm(), 4.1, 0.5) << "by the packet that completes a telegram";
}

/// The scans as received with the first packet of each telegram: an independent reader's table.
std::vector<std::shared_ptr<const Scan>> stamped_by_first_packet(
    const std::vector<std::shared_ptr<const Scan>>& scans, std::istream& table) {
  std::vector<std::shared_ptr<const Scan>> stamped;
  std::string line;
  std::getline(table, line);  // names of the columns
  for (const auto& scan : scans) {
    std::getline(table, line);
    std::istringstream cells(line);
    std::string cell;
    for (int column = 0; column <= 4; ++column) std::getline(cells, cell, ',');
    Scan copy = *scan;
    copy.receipt_ns = std::stoll(cell);
    stamped.push_back(std::make_shared<const Scan>(std::move(copy)));
  }
  return stamped;
}

TEST_P(Replay, OfATim781sHasTheClockThatWasFoundIndependently) {
  const auto path = shared_data() / "sick/tim781s-20210106-colab.pcapng";
  std::ifstream table(shared_data() / "clocks/sick_tim781_tcp.csv");
  if (!fs::exists(path) || !table) GTEST_SKIP() << "no shared data: " << path.filename();
  const DeviceReport report = align(replay(stamped_by_first_packet(read_offline(path), table), GetParam()));
  EXPECT_NEAR(report.clock->skew_ppm(), 4.5, 0.25);
  EXPECT_NEAR(report.clock->residual_median, 72e-6, 5e-6);
  EXPECT_NEAR(report.clock->residual_95, 271e-6, 10e-6);
}

INSTANTIATE_TEST_SUITE_P(Each, Replay, testing::Values(ColaLanguage::A, ColaLanguage::B),
                         [](const auto& language) {
                           return language.param == ColaLanguage::A ? "ColaA" : "ColaB";
                         });

/// All scans that a recorded device sends, and what was noted.
struct Heard {
  std::vector<std::shared_ptr<const Scan>> scans;
  CaptureStatistics statistics;
};

Heard hear(const test::RecordedDevice& device, std::size_t scans, SickSettings settings = {}) {
  settings.reply_timeout = 5;
  settings.silence = 600;
  LiveSource source(test::rig_of_one(device.port()), {.plate = false, .sick = settings});
  Heard heard;
  while (heard.scans.size() < scans) {
    auto item = source.next_within(test::kPatience);
    if (!item) break;
    heard.scans.push_back(std::get<std::shared_ptr<const Scan>>(*item));
  }
  heard.statistics = source.close();
  return heard;
}

TEST(RealDialogue, GivesEachScanOnceAmongOtherTelegrams) {
  for (const auto& [name, scans] : {std::pair{"lms111-20210302-colab.json", 172U},
                                    {"lms511-20210301-colab.json", 136U},
                                    {"lms511-20210302-colab.json", 174U}}) {
    const auto path = shared_data() / "sick" / name;
    if (!fs::exists(path)) GTEST_SKIP() << "no shared data: " << path.filename();
    const auto dialogue = test::read_dialogue(path);
    const auto offline = test::scans_of(dialogue);
    ASSERT_EQ(offline.size(), scans);
    const test::RecordedDevice device(dialogue, ColaLanguage::B);
    const Heard heard = hear(device, scans);
    ASSERT_EQ(heard.scans.size(), offline.size()) << name;
    for (std::size_t i = 0; i < offline.size(); ++i) expect_same(*heard.scans[i], offline[i]);
    const auto& laser = heard.statistics.devices.at(0);
    EXPECT_THAT(laser.losses.all(), testing::Each(testing::Pair(testing::_, 0))) << name;
    EXPECT_EQ(test::count_beginning(laser.notes, "refused"), 0U) << name;
  }
}

TEST(RealDialogue, SurvivesRealRefusalsAndReportsThemInWords) {
  const auto path = shared_data() / "sick/lms511-20210301-colab.json";
  if (!fs::exists(path)) GTEST_SKIP() << "no shared data: " << path.filename();
  const test::RecordedDevice device(test::read_dialogue(path), ColaLanguage::B);
  const Heard heard = hear(device, 136, {.configuration = {.ntp_off = true}});
  EXPECT_EQ(heard.scans.size(), 136U);
  const auto& laser = heard.statistics.devices.at(0);
  EXPECT_EQ(test::count_beginning(laser.notes, "refused by the laser: sWN TSCRole: sFA 3 (unknown variable"),
            1U);
  EXPECT_GE(test::count_beginning(laser.telegrams, "sFA 3"), 1U);
}

TEST(RealDialogue, DoesNotMistakeATelegramWhoseNameBeginsTheSame) {
  const auto path = shared_data() / "sick/tim781s-lmdscandatamon-colab.json";
  if (!fs::exists(path)) GTEST_SKIP() << "no shared data: " << path.filename();
  const auto dialogue = test::read_dialogue(path);
  const auto offline = test::scans_of(dialogue);
  ASSERT_EQ(offline.size(), 12U);
  const Heard heard = hear(test::RecordedDevice(dialogue, ColaLanguage::B), 12);
  ASSERT_EQ(heard.scans.size(), 12U);
  for (std::size_t i = 0; i < 12; ++i) expect_same(*heard.scans[i], offline[i]);
  const auto& laser = heard.statistics.devices.at(0);
  EXPECT_GE(laser.telegrams.of("sSN LMDscandatamon"), 11U) << "the last may not have been read any more";
  EXPECT_EQ(laser.items, 12U);
}

TEST(RealDialogue, WithARadarThatHasNoScansIsGivenUpInWords) {
  const auto path = shared_data() / "sick/rms1xxx-20221018-colaa.json";
  if (!fs::exists(path)) GTEST_SKIP() << "no shared data: " << path.filename();
  auto dialogue = test::read_dialogue(path);
  // As the radar would: no such event. Its dialogue has no refusal.
  dialogue.push_back({.to_device = true, .command = "sEN", .name = "LMDscandata", .bytes = {}});
  dialogue.push_back({.command = "sFA", .name = "", .bytes = cola_error(15, ColaLanguage::A)});
  const test::RecordedDevice device(dialogue, ColaLanguage::A);
  LiveSource source(test::rig_of_one(device.port()), {.plate = false, .sick = {.reply_timeout = 0.2}});
  EXPECT_TRUE(test::comes_true(source, "laser1", [](const DeviceStatistics& laser) {
    return test::count_beginning(laser.notes, "refused by the laser: sEN LMDscandata: sFA 15") >= 1;
  }));
  const auto statistics = source.close();
  EXPECT_GE(statistics.devices.at(0).telegrams.of("sRA SCdevicestate"), 1U) << "CoLa-A was found out";
}

/// Sends a request to a server and returns the one answer.
std::string request_scan(boost::asio::ip::tcp::socket& socket, const Bytes& request) {
  boost::asio::write(socket, boost::asio::buffer(request));
  ColaFramer framer;
  std::string answer;
  while (answer.empty()) {
    Bytes byte(1);
    boost::asio::read(socket, boost::asio::buffer(byte));
    framer.feed(byte, 0, [&](const ColaFrame& frame) {
      const auto telegram = parse_cola(frame.payload, frame.language);
      answer = std::string(telegram->command) + " " + std::string(telegram->name);
    });
  }
  return answer;
}

class RealRequests : public testing::TestWithParam<const char*> {};

TEST_P(RealRequests, AreAnsweredByTheEmulatedLaserAsByTheRealOne) {
  const auto path = shared_data() / "sick" / GetParam();
  if (!fs::exists(path)) GTEST_SKIP() << "no shared data: " << path.filename();
  Emulator emulator(test::loopback_rig(1), {.speed = 0});
  boost::asio::io_context context;
  boost::asio::ip::tcp::socket socket(context);
  socket.connect({boost::asio::ip::make_address("127.0.0.1"), emulator.rig().lasers[0].address.port});
  std::set<std::string> refused;
  bool subscribed = false;
  for (const auto& telegram : test::read_dialogue(path)) {
    if (!telegram.to_device) continue;
    const std::string answer = request_scan(socket, telegram.bytes);
    if (answer.starts_with("sFA")) {
      refused.insert(telegram.name.substr(0, 5));
    } else {
      const std::map<std::string, std::string> answers{
          {"sRN", "sRA"}, {"sWN", "sWA"}, {"sMN", "sAN"}, {"sEN", "sEA"}};
      EXPECT_EQ(answer, answers.at(telegram.command) + " " + telegram.name);
    }
    subscribed = subscribed || answer == "sEA LMDscandata";
  }
  EXPECT_TRUE(subscribed);
  EXPECT_THAT(refused, testing::IsEmpty()) << "some drivers give up where a laser refuses a field";
}

INSTANTIATE_TEST_SUITE_P(Of, RealRequests,
                         testing::Values("lms111-20210302-colab.json", "lms511-20210301-colab.json"),
                         [](const auto& name) { return std::string(name.param).substr(0, 6); });

}  // namespace
}  // namespace crisp
