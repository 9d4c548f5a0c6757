// SPDX-License-Identifier: BSD-3-Clause
// Recordings that are there already, whole or damaged, and are written on.
#include <algorithm>
#include <cstring>

#include <crisp/error.hpp>

#include "grabbers/capture/capture_file.hpp"
#include "grabbers/capture/dissect.hpp"
#include "grabbers/capture/frame_builder.hpp"
#include "grabbers/record/record_stage.hpp"
#include "tests/grabbers/record/capture_recorder_fixture.hpp"
#include "tests/support/simulated_items.hpp"
#include "tests/support/stage_driver.hpp"

namespace crisp {
namespace {

using namespace crisp::capture;
using namespace crisp::devices;
using namespace crisp::record;
using namespace crisp::wire;

/// The items as they would have come an hour later.
std::vector<HubItem> an_hour_later(const std::vector<HubItem>& items) {
  constexpr std::int64_t kHour = 3'600'000'000'000;
  std::vector<HubItem> later;
  for (const HubItem& item : items) {
    if (const auto* scan = std::get_if<std::shared_ptr<const Scan>>(&item)) {
      auto copy = **scan;
      copy.receipt_ns += kHour;
      later.emplace_back(std::make_shared<const Scan>(std::move(copy)));
    } else {
      auto copy = std::get<PlateReading>(item);
      copy.receipt_ns += kHour;
      later.emplace_back(copy);
    }
  }
  return later;
}

TEST_F(CaptureRecorderTest, AppendsASecondRecordingOfWhichNothingIsLost) {
  const auto first = test::simulated_items(0.5);
  const auto second = an_hour_later(first);
  for (const auto& items : {first, second}) {
    CaptureRecorder recorder(folder_ / "hub.pcap", default_rig(), {});
    for (const HubItem& item : items) recorder.write(item);
    recorder.close();
  }
  auto both = first;
  both.insert(both.end(), second.begin(), second.end());
  expect_same(read(folder_ / "hub.pcap"), both);
}

void record_all(CaptureRecorder& recorder, const std::vector<HubItem>& items) {
  for (const HubItem& item : items) recorder.write(item);
  recorder.close();
}

/// Where the header of a record in the middle of a pcap file begins.
std::size_t middle_record(const std::string& bytes) {
  std::size_t at = 24;
  while (at < bytes.size() / 2) {
    std::uint32_t captured = 0;
    std::memcpy(&captured, bytes.data() + at + 8, sizeof captured);
    at += 16 + captured;
  }
  return at;
}

TEST_F(CaptureRecorderTest, GoesOnBehindADamagedRecordAndShortensNothing) {
  const auto first = test::simulated_items(0.5);
  const auto second = an_hour_later(first);
  CaptureRecorder sound(folder_ / "sound.pcap", default_rig(), {});
  record_all(sound, first);
  const std::string whole = test::bytes_of(folder_ / "sound.pcap");
  for (const int bit : {0, 5, 13, 20, 31}) {  // of the number of bytes that the record holds
    std::string damaged = whole;
    char& byte = damaged[middle_record(whole) + 8 + bit / 8];
    byte = static_cast<char>(byte ^ (1 << bit % 8));
    test::put_bytes(folder_ / "hub.pcap", damaged);
    CaptureRecorder recorder(folder_ / "hub.pcap", default_rig(), {});
    record_all(recorder, second);
    EXPECT_THAT(recorder.notes(), testing::ElementsAre(testing::HasSubstr("hub.pcap is damaged: ")));
    const std::string after = test::bytes_of(folder_ / "hub.pcap");
    ASSERT_GT(after.size(), damaged.size());
    EXPECT_EQ(after.substr(0, damaged.size()), damaged);
    const auto both = read(folder_ / "hub.pcap", true);
    ASSERT_GT(both.size(), second.size());
    expect_same({both.end() - static_cast<std::ptrdiff_t>(second.size()), both.end()}, second);
  }
}

TEST_F(CaptureRecorderTest, BeginsAnotherFileWhereNothingBehindTheEndCouldBeRead) {
  const auto first = test::simulated_items(0.5);
  const auto second = an_hour_later(first);
  CaptureRecorder sound(folder_ / "hub.pcap", default_rig(), {});
  record_all(sound, first);
  // What a power cut leaves on some file systems.
  const std::string zeros_at_end = test::bytes_of(folder_ / "hub.pcap") + std::string(5000, '\0');
  test::put_bytes(folder_ / "hub.pcap", zeros_at_end);
  CaptureRecorder recorder(folder_ / "hub.pcap", default_rig(), {});
  record_all(recorder, second);
  EXPECT_THAT(recorder.files(), testing::ElementsAre(folder_ / "hub-2.pcap"));
  EXPECT_THAT(recorder.notes(),
              testing::ElementsAre(testing::HasSubstr("its last 5000 bytes are unreadable")));
  EXPECT_EQ(test::bytes_of(folder_ / "hub.pcap"), zeros_at_end);
  expect_same(read(folder_ / "hub-2.pcap"), second);
}

TEST_F(CaptureRecorderTest, TruncatesAHalfWrittenRecordAndReportsIt) {
  const auto items = test::simulated_items(0.1);
  CaptureRecorder sound(folder_ / "hub.pcap", default_rig(), {});
  record_all(sound, items);
  fs::resize_file(folder_ / "hub.pcap", fs::file_size(folder_ / "hub.pcap") - 7);
  CaptureRecorder recorder(folder_ / "hub.pcap", default_rig(), {});
  record_all(recorder, an_hour_later(items));
  EXPECT_THAT(recorder.notes(), testing::ElementsAre(testing::HasSubstr("ended within a record")));
  EXPECT_EQ(read(folder_ / "hub.pcap", true).size(), 2 * items.size());
}

TEST_F(CaptureRecorderTest, WarnsOfADamagedRecordingThatItGoesOnWith) {
  const auto items = test::simulated_items(0.1);
  const fs::path file = folder_ / "hub.pcap";
  CaptureRecorder sound(file, default_rig(), {});
  record_all(sound, items);
  std::string damaged = test::bytes_of(file);
  damaged[middle_record(damaged) + 11] = '\x7f';
  test::put_bytes(file, damaged);
  auto stage = test::StageDriver::of<RecordStage>({{"file", OptionValue(OptionScalar(file.string()))}});
  for (const HubItem& item : items) {
    if (const auto* reading = std::get_if<PlateReading>(&item)) stage.feed(*reading);
  }
  stage.finish();
  EXPECT_THAT(stage.report().warnings, testing::ElementsAre(testing::HasSubstr("hub.pcap is damaged: ")));
}

TEST_F(CaptureRecorderTest, RefusesToWriteThroughALink) {
  for (const char* target : {"elsewhere.pcap", "none.pcap"}) {
    fs::remove(folder_ / "hub.pcap");
    fs::create_symlink(folder_ / target, folder_ / "hub.pcap");
    CaptureRecorder elsewhere(folder_ / "elsewhere.pcap", default_rig(), {});
    record_all(elsewhere, test::simulated_items(0.1));
    const std::string before = test::bytes_of(folder_ / "elsewhere.pcap");
    EXPECT_THROW(CaptureRecorder(folder_ / "hub.pcap", default_rig(), {}), Error);
    EXPECT_EQ(test::bytes_of(folder_ / "elsewhere.pcap"), before);
  }
  EXPECT_FALSE(fs::exists(folder_ / "none.pcap"));
}

TEST_F(CaptureRecorderTest, LeavesASimulatedCaptureAsItIs) {
  const fs::path file = folder_ / "hub.pcap";
  CaptureRecorder sound(folder_ / "own.pcap", default_rig(), {});
  record_all(sound, test::simulated_items(0.1));
  CaptureFile own(folder_ / "own.pcap");
  PcapWriter simulated(file, PcapMode::Grow);
  while (const Packet* packet = own.next()) {
    Bytes frame(packet->bytes.begin(), packet->bytes.end());
    mark_as_simulated(frame);
    simulated.write(packet->time_ns, frame);
  }
  simulated.close();
  const std::string before = test::bytes_of(file);
  try {
    const CaptureRecorder recorder(file, default_rig(), {});
    FAIL() << "a simulation and a recording in one file";
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("hub.pcap exists and is a simulated capture"));
  }
  EXPECT_EQ(test::bytes_of(file), before);
}

TEST_F(CaptureRecorderTest, BeginsTheConnectionsOfEachRecordingWithNumbersOfTheirOwn) {
  const auto first = test::simulated_items(0.1);
  std::vector<std::uint32_t> begins;
  for (const auto& items : {first, an_hour_later(first)}) {
    fs::remove(folder_ / "hub.pcap");
    CaptureRecorder recorder(folder_ / "hub.pcap", default_rig(), {});
    for (const HubItem& item : items) recorder.write(item);
    recorder.close();
    CaptureFile file(folder_ / "hub.pcap");
    while (const Packet* packet = file.next()) {
      bool damaged = false;
      const auto ip = std::get<IpPacket>(dissect_ip(*packet));
      const auto segment = dissect_transport(ip, damaged);
      if (segment && segment->syn) begins.push_back(segment->sequence);
    }
  }
  ASSERT_THAT(begins, testing::SizeIs(12));  // of three lasers and the hub, twice
  std::ranges::sort(begins);
  EXPECT_EQ(std::unique(begins.begin(), begins.end()), begins.end());
}

}  // namespace
}  // namespace crisp
