// SPDX-License-Identifier: BSD-3-Clause
// The emulator and the live source in one process, over loopback.
#include "grabbers/live/live_source.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <future>
#include <map>

#include <crisp/capture_reader.hpp>
#include <crisp/error.hpp>

#include "grabbers/emulate/emulator.hpp"
#include "grabbers/simulate/recorded_capture.hpp"
#include "grabbers/simulate/scenes.hpp"
#include "grabbers/wire/scan_encoding.hpp"
#include "pipeline/data/degree.hpp"
#include "tests/grabbers/live/live_support.hpp"
#include "tests/support/temporary_folder.hpp"

namespace crisp {
namespace {

using namespace crisp::data;
using namespace crisp::emulate;
using namespace crisp::live;
using namespace crisp::simulate;
using namespace crisp::wire;
namespace fs = std::filesystem;
using namespace std::chrono_literals;

using test::loopback_rig;
using test::of;

std::vector<HubItem> recorded_items(double seconds = 0.5) {
  const test::TemporaryFolder folder;
  const fs::path file = folder / "hub.pcap";
  RecordingSettings settings;
  settings.scanner.duration = seconds;
  RecordingSimulator simulator(settings, office());
  RecordedCapture capture(file, settings, simulator.truth());
  while (const auto event = simulator.next()) capture.write(*event);
  capture.close();
  CaptureReader reader(file, settings.scanner.rig);
  std::vector<HubItem> items;
  while (auto item = reader.next()) items.push_back(std::move(*item));
  return items;
}

/// Scans of one laser, in their order.
std::vector<std::shared_ptr<const Scan>> scans_of(const std::vector<HubItem>& items, std::uint16_t laser) {
  std::vector<std::shared_ptr<const Scan>> scans;
  for (const HubItem& item : items) {
    const auto* scan = std::get_if<std::shared_ptr<const Scan>>(&item);
    if (scan != nullptr && (*scan)->laser == laser) scans.push_back(*scan);
  }
  return scans;
}

std::size_t scans_in(const std::vector<HubItem>& items) {
  return scans_of(items, 0).size() + scans_of(items, 1).size() + scans_of(items, 2).size();
}

/// Takes items until so many scans have come.
std::vector<HubItem> take_scans(LiveSource& source, std::size_t scans) {
  const auto deadline = std::chrono::steady_clock::now() + test::kPatience;
  std::vector<HubItem> items;
  std::size_t found = 0;
  while (found < scans && std::chrono::steady_clock::now() < deadline) {
    auto item = source.next_within(100ms);
    if (!item) continue;
    if (!std::holds_alternative<PlateReading>(*item)) ++found;
    items.push_back(std::move(*item));
  }
  return items;
}

/// The emulator fed in a thread of its own.
struct Feeding {
  Feeding(Emulator& emulator, const std::vector<HubItem>& items)
      : thread([&] {
          for (const HubItem& item : items) emulator.send(item, [this] { return stop.load(); });
          emulator.finish();
        }) {}
  ~Feeding() {
    stop = true;
    thread.join();
  }
  std::atomic<bool> stop = false;
  std::thread thread;
};

class LiveSourceIn : public testing::TestWithParam<ColaLanguage> {};

TEST_P(LiveSourceIn, GivesScanForScanWhatTheOfflineReaderGives) {
  const auto recorded = recorded_items();
  ASSERT_GT(scans_in(recorded), 60U);
  // The plate's port is known once the source listens, the lasers' once the emulator does.
  Emulator lasers(loopback_rig(), {.speed = 0});
  LiveSettings settings{.plate_at = {.port = 0}};
  settings.sick.language = GetParam();
  LiveSource source(lasers.rig(), settings);
  Emulator plate({}, {.speed = 0, .plate_to = {"127.0.0.1", source.plate_port()}});
  std::vector<HubItem> scans;
  std::vector<HubItem> readings;
  for (const HubItem& item : recorded) {
    (std::holds_alternative<PlateReading>(item) ? readings : scans).push_back(item);
  }
  std::vector<HubItem> live;
  {
    const Feeding feeding(lasers, scans);
    live = take_scans(source, scans.size());
  }
  for (std::uint16_t laser = 0; laser < 3; ++laser) {
    const auto expected = scans_of(recorded, laser);
    const auto found = scans_of(live, laser);
    ASSERT_EQ(found.size(), expected.size());
    for (std::size_t k = 0; k < expected.size(); ++k) {
      EXPECT_EQ(to_scan_data(*found[k]), to_scan_data(*expected[k]));
      EXPECT_EQ(found[k]->angle_step, expected[k]->angle_step);
      EXPECT_GT(found[k]->receipt_ns, 1'700'000'000'000'000'000);
    }
  }
  // Datagrams may be lost where the kernel's buffer is full; those are counted, but for the last ones.
  std::vector<PlateReading> came;
  for (const HubItem& item : readings) {
    plate.send(item, [] { return false; });
    while (const auto received = source.next_within(1ms)) came.push_back(std::get<PlateReading>(*received));
  }
  while (const auto received = source.next_within(200ms)) came.push_back(std::get<PlateReading>(*received));
  const auto statistics = source.close();
  ASSERT_GT(came.size(), readings.size() / 2);
  const auto first = std::get<PlateReading>(readings.front()).sequence;
  for (const PlateReading& reading : came) {
    const auto& sent =
        std::get<PlateReading>(readings.at(static_cast<std::uint16_t>(reading.sequence - first)));
    EXPECT_EQ(reading.count, sent.count);
    EXPECT_EQ(reading.device_us, sent.device_us);
  }
  EXPECT_LE(came.size() + of(statistics, "plate").losses.of(kReadingsNeverCame), readings.size());
  EXPECT_EQ(of(statistics, "laser2").items, scans_of(recorded, 1).size());
  EXPECT_THAT(of(statistics, "laser2").losses.all(), testing::Each(testing::Pair(testing::_, 0)));
  EXPECT_EQ(statistics.losses.of("items dropped because the pipeline was too slow"), 0U);
}

INSTANTIATE_TEST_SUITE_P(Each, LiveSourceIn, testing::Values(ColaLanguage::A, ColaLanguage::B),
                         [](const auto& language) {
                           return language.param == ColaLanguage::A ? "ColaA" : "ColaB";
                         });

TEST(LiveSource, ConfiguresALaserAndReportsWhatItDoesNotDo) {
  const auto scans = scans_of(recorded_items(0.1), 0);
  Emulator emulator(loopback_rig(1), {.speed = 0});
  const SickConfiguration requested{.frequency = 25, .output_range = {0, 90 * kDegree}, .remission = false};
  LiveSource source(emulator.rig(), {.plate = false, .sick = {.configuration = requested}});
  const std::vector<HubItem> items(scans.begin(), scans.end());
  std::vector<HubItem> came;
  {
    const Feeding feeding(emulator, items);
    came = take_scans(source, items.size());
  }
  ASSERT_EQ(came.size(), scans.size());
  for (const auto& scan : scans_of(came, 0)) {
    EXPECT_NEAR(scan->start_angle, 0, 1e-6);
    EXPECT_EQ(scan->echoes.at(0).ranges.size(), 181U);
    EXPECT_THAT(scan->echoes[0].remissions, testing::IsEmpty());
  }
  const auto notes = of(source.close(), "laser1").notes;
  EXPECT_EQ(
      test::count_beginning(notes, "refused by the laser: sMN mLMPsetscancfg: answered 1 (the frequency"),
      1U);
  EXPECT_EQ(notes.of("connections whose scans were not as configured: 50 Hz instead of 25 Hz"), 1U);
}

TEST(LiveSource, ConfiguresALaserOf25HertzWithAnEncoder) {
  auto scan = *scans_of(recorded_items(0.1), 0).front();
  scan.scan_frequency = 25;
  scan.angle_step = 0.25 * kDegree;
  for (std::vector<float>* values : {&scan.echoes[0].ranges, &scan.echoes[0].remissions})
    values->resize(1081);
  scan.encoders = {{.position = 123}};
  Rig rig = loopback_rig(1);
  rig.plate.encoder_of = 0;
  const std::vector<HubItem> items = {std::make_shared<const Scan>(scan)};
  Emulator emulator(rig, {.speed = 0});
  emulator.send(items.front(), [] { return true; });  // it answers as this scan is
  const SickConfiguration requested{.frequency = 25, .resolution = 0.5 * kDegree, .remission = true};
  LiveSource source(emulator.rig(), {.sick = {.configuration = requested}});
  std::vector<HubItem> came;
  {
    const Feeding feeding(emulator, items);
    came = take_scans(source, 1);
  }
  ASSERT_EQ(came.size(), 2U) << "a scan, and the count in it, which stays with remissions";
  EXPECT_EQ(std::get<PlateReading>(came[0]).count, 123U);
  EXPECT_EQ(scans_of(came, 0).at(0)->echoes.at(0).ranges.size(), 541U) << "every second beam";
  EXPECT_THAT(of(source.close(), "laser1").notes.all(), testing::IsEmpty());
}

TEST(LiveSource, GoesOnWhenALaserComesBack) {
  const auto recorded = recorded_items();
  const auto some = std::vector<HubItem>(recorded.begin(),
                                         recorded.begin() + static_cast<std::ptrdiff_t>(recorded.size() / 2));
  const auto rest = std::vector<HubItem>(recorded.begin() + static_cast<std::ptrdiff_t>(recorded.size() / 2),
                                         recorded.end());
  auto emulator = std::make_unique<Emulator>(loopback_rig(), EmulatorSettings{.speed = 0});
  const Rig rig = emulator->rig();
  LiveSource source(rig, {.plate = false});
  {
    const Feeding feeding(*emulator, some);
    EXPECT_EQ(take_scans(source, scans_in(some)).size(), scans_in(some));
  }
  emulator.reset();
  emulator = std::make_unique<Emulator>(rig, EmulatorSettings{.speed = 0});
  {
    const Feeding feeding(*emulator, rest);
    EXPECT_EQ(take_scans(source, scans_in(rest)).size(), scans_in(rest));
  }
  const auto statistics = source.close();
  EXPECT_EQ(of(statistics, "laser1").items, scans_of(recorded, 0).size());
  EXPECT_GE(test::count_beginning(of(statistics, "laser1").notes, "connections that failed"), 1U);
}

TEST(LiveSource, SurvivesAllFaultsOfTheEmulatorAndCountsWhatNeverCame) {
  const auto recorded = recorded_items(3);
  Emulator emulator(
      loopback_rig(),
      {.speed = 0,
       .faults = {
           .dropped = 0.03, .stalled = 0.02, .stall = 0.01, .split = 0.5, .damaged = 0.05, .seed = 7}});
  LiveSource source(emulator.rig(), {.plate = false, .sick = {.reply_timeout = 5, .silence = 5}});
  std::map<std::pair<int, std::uint16_t>, std::shared_ptr<const Scan>> sent;
  for (std::uint16_t laser = 0; laser < 3; ++laser) {
    for (const auto& scan : scans_of(recorded, laser)) sent[{laser, scan->telegram_counter}] = scan;
  }
  std::vector<HubItem> came;
  {
    auto feeding = std::async(std::launch::async, [&] {
      for (const HubItem& item : recorded) emulator.send(item, [] { return false; });
      emulator.finish();
    });
    while (feeding.wait_for(0s) != std::future_status::ready) {
      while (auto item = source.next_within(10ms)) came.push_back(std::move(*item));
    }
    while (auto item = source.next_within(200ms)) came.push_back(std::move(*item));
  }
  const auto statistics = source.close();
  std::uint64_t damaged = 0;
  for (std::uint16_t laser = 0; laser < 3; ++laser) {
    const auto scans = scans_of(came, laser);
    const auto& device = statistics.devices.at(laser);
    ASSERT_GT(scans.size(), 100U);
    const auto span =
        static_cast<std::uint16_t>(scans.back()->telegram_counter - scans.front()->telegram_counter);
    EXPECT_EQ(scans.size() + device.losses.of(kTelegramsNeverCame), span + 1U)
        << "what did not come is counted";
    for (const auto& scan : scans) {
      EXPECT_EQ(to_scan_data(*scan), to_scan_data(*sent.at({laser, scan->telegram_counter})));
    }
    damaged += device.losses.of("telegrams with a wrong checksum");
    EXPECT_GT(device.losses.of(kTelegramsNeverCame), 0U);
  }
  EXPECT_GT(damaged, 0U);
}

TEST(LiveSource, RefusesAddressesThatItCannotUse) {
  Rig rig = loopback_rig();
  rig.lasers[1].address.ip = "laser.example";
  EXPECT_THROW(LiveSource(rig, {.plate = false}), Error);
  EXPECT_THROW(LiveSource(loopback_rig(), {.lasers = false, .plate_at = {.listen = "192.0.2.1"}}), Error);
  const LiveSource first(loopback_rig(), {.lasers = false, .plate_at = {.port = 0}});
  EXPECT_THROW(LiveSource(loopback_rig(), {.lasers = false, .plate_at = {.port = first.plate_port()}}),
               Error);
}

TEST(Emulator, SendsThePlatesDatagramsFromItsAddress) {
  Rig rig = loopback_rig(0);
  rig.plate.address.ip = "127.0.0.2";
  LiveSource source(rig, {.lasers = false, .plate_at = {.port = 0}});
  Emulator emulator(rig,
                    {.speed = 0, .wait_for_clients = false, .plate_to = {"127.0.0.1", source.plate_port()}});
  emulator.send(PlateReading{.sequence = 7}, [] { return false; });
  const auto item = source.next_within(test::kPatience);
  ASSERT_TRUE(item);
  EXPECT_EQ(std::get<PlateReading>(*item).sequence, 7U);
}

TEST(Emulator, ListensAtLoopbackAloneUnlessAllowed) {
  Rig rig = loopback_rig();
  rig.lasers[2].address.ip = "0.0.0.0";
  EXPECT_THROW(Emulator(rig, {}), Error);
  EXPECT_NO_THROW(Emulator(rig, {.network = true}));
}

}  // namespace
}  // namespace crisp
