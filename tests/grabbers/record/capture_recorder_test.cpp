// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/record/capture_recorder.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstring>
#include <fstream>
#include <thread>

#include "grabbers/capture/capture_file.hpp"
#include "grabbers/capture/capture_reader.hpp"
#include "grabbers/capture/dissect.hpp"
#include "grabbers/capture/network_frames.hpp"
#include "grabbers/record/record_stage.hpp"
#include "grabbers/wire/scan_encoding.hpp"
#include "pipeline/data/error.hpp"
#include "tests/support/simulated_items.hpp"
#include "tests/support/stage_driver.hpp"
#include "tests/support/temporary_folder.hpp"

namespace crisp {
namespace {

namespace fs = std::filesystem;

class CaptureRecorderTest : public testing::Test {
 protected:
  static std::vector<HubItem> read(const fs::path& file, bool ends_early = false) {
    CaptureReader reader(file, default_rig());
    std::vector<HubItem> items;
    while (auto item = reader.next()) items.push_back(std::move(*item));
    for (const auto& device : reader.statistics().devices) {
      if (ends_early) continue;  // within a telegram
      EXPECT_THAT(device.losses.all(), testing::Each(testing::Pair(testing::_, 0))) << device.name;
    }
    return items;
  }

  static void expect_same(const std::vector<HubItem>& read, const std::vector<HubItem>& written) {
    ASSERT_EQ(read.size(), written.size());
    for (std::size_t i = 0; i < read.size(); ++i) {
      ASSERT_EQ(receipt_ns(read[i]), receipt_ns(written[i])) << i;
      ASSERT_EQ(read[i].index(), written[i].index()) << i;
      if (const auto* scan = std::get_if<std::shared_ptr<const Scan>>(&read[i])) {
        const auto& other = std::get<std::shared_ptr<const Scan>>(written[i]);
        EXPECT_EQ((*scan)->laser, other->laser);
        EXPECT_EQ((*scan)->echoes.at(0).ranges, other->echoes.at(0).ranges);
        EXPECT_EQ(to_scan_data(**scan), to_scan_data(*other));
      } else {
        const auto& reading = std::get<PlateReading>(read[i]);
        const auto& other = std::get<PlateReading>(written[i]);
        EXPECT_EQ(reading.sequence, other.sequence);
        EXPECT_EQ(reading.device_us, other.device_us);
        EXPECT_EQ(reading.count, other.count);
      }
    }
  }

  test::TemporaryFolder folder_;
};

TEST_F(CaptureRecorderTest, IsReadBackItemForItemWithItsTimes) {
  const auto items = test::simulated_items(0.5);
  CaptureRecorder recorder(folder_ / "hub.pcap", default_rig(), {});
  for (const HubItem& item : items) recorder.write(item);
  recorder.close();
  expect_same(read(folder_ / "hub.pcap"), items);
}

TEST_F(CaptureRecorderTest, HoldsWhatWasWrittenASecondBeforeAPowerCut) {
  const auto items = test::simulated_items(0.5);
  CaptureRecorder recorder(folder_ / "hub.pcap", default_rig(), {.safe_after = 0});
  for (const HubItem& item : items) recorder.write(item);
  // Nothing is closed: what another process sees now is what a power cut would leave.
  const auto safe = read(folder_ / "hub.pcap");
  ASSERT_FALSE(safe.empty());
  EXPECT_LT(receipt_ns(items.back()) - receipt_ns(safe.back()), 50'000'000);
  expect_same(safe, {items.begin(), items.begin() + static_cast<std::ptrdiff_t>(safe.size())});
}

TEST_F(CaptureRecorderTest, PutsOnTheDiskWhatCameAlsoWhenNothingMoreComes) {
  const auto items = test::simulated_items(0.5);
  CaptureRecorder recorder(folder_ / "hub.pcap", default_rig(), {.safe_after = 0.05});
  for (const HubItem& item : items) recorder.write(item);
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(60);
  std::vector<HubItem> safe;
  while (safe.size() < items.size() && std::chrono::steady_clock::now() < deadline) {
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    safe = read(folder_ / "hub.pcap", true);
  }
  expect_same(safe, items);
}

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
    damaged[middle_record(whole) + 8 + bit / 8] ^= static_cast<char>(1 << bit % 8);
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
              testing::ElementsAre(testing::HasSubstr("its last 5000 bytes cannot be read")));
  EXPECT_EQ(test::bytes_of(folder_ / "hub.pcap"), zeros_at_end);
  expect_same(read(folder_ / "hub-2.pcap"), second);
}

TEST_F(CaptureRecorderTest, CutsOffARecordThatACrashLeftHalfWrittenAndSaysSo) {
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
    EXPECT_THAT(error.what(), testing::HasSubstr("hub.pcap is there already and is a simulated capture"));
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

/// No file may become larger, while it lives: as on a full disk.
class FullDisk {
 public:
  explicit FullDisk(rlim_t bytes) {
    std::signal(SIGXFSZ, SIG_IGN);
    getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit limit{.rlim_cur = bytes, .rlim_max = before_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FullDisk() { setrlimit(RLIMIT_FSIZE, &before_); }
  FullDisk(const FullDisk&) = delete;
  FullDisk& operator=(const FullDisk&) = delete;

 private:
  rlimit before_{};
};

TEST_F(CaptureRecorderTest, LeavesWholeRecordsOnAFullDisk) {
  const auto items = test::simulated_items(0.5);
  {
    const FullDisk full(50'000);
    CaptureRecorder recorder(folder_ / "hub.pcap", default_rig(), {});
    EXPECT_THROW(
        {
          for (int i = 0; i < 100; ++i) {
            for (const HubItem& item : items) recorder.write(item);
          }
          recorder.close();
        },
        Error);
  }
  const auto safe = read(folder_ / "hub.pcap", true);
  ASSERT_FALSE(safe.empty());
  expect_same(safe, {items.begin(), items.begin() + static_cast<std::ptrdiff_t>(safe.size())});
}

TEST_F(CaptureRecorderTest, EndsOnAFullDiskWithoutThePipeline) {
  const auto items = test::simulated_items(0.5);
  auto stage = test::StageDriver::of<RecordStage>(
      {{"file", OptionValue(OptionScalar((folder_ / "hub.pcap").string()))}});
  std::uint64_t fed = 0;
  {
    const FullDisk full(50'000);
    for (int i = 0; i < 3; ++i) {
      for (const HubItem& item : items) {
        if (const auto* scan = std::get_if<std::shared_ptr<const Scan>>(&item)) {
          stage.feed(*scan);
        } else {
          stage.feed(std::get<PlateReading>(item));
        }
        ++fed;
      }
    }
    stage.finish();
  }
  ASSERT_EQ(stage.report().doubts.size(), 1U);
  EXPECT_THAT(stage.report().doubts[0],
              testing::StartsWith("the recording ended early: cannot write the capture"));
  const std::uint64_t missing = stage.report().counts.at("items that were not recorded");
  EXPECT_GT(missing, fed / 2);
  EXPECT_LT(missing, fed);
}

TEST_F(CaptureRecorderTest, FailsWhereNothingWasReceived) {
  const fs::path file = folder_ / "hub.pcap";
  auto stage = test::StageDriver::of<RecordStage>({{"file", OptionValue(OptionScalar(file.string()))}});
  try {
    stage.finish();
    FAIL() << "a recording of nothing is one";
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("nothing was received"));
  }
  EXPECT_FALSE(fs::exists(file));
}

TEST_F(CaptureRecorderTest, BeginsANewFileAfterATimeOrASize) {
  const auto items = test::simulated_items(0.5);
  for (const RecorderSettings& settings :
       {RecorderSettings{.most_seconds = 0.2}, RecorderSettings{.most_bytes = 60'000}}) {
    CaptureRecorder recorder(folder_ / "part.pcap", default_rig(), settings);
    for (const HubItem& item : items) recorder.write(item);
    recorder.close();
    ASSERT_GE(recorder.files().size(), 3U);
    EXPECT_EQ(recorder.files()[1].filename(), "part-2.pcap");
    std::vector<HubItem> all;
    for (const auto& file : recorder.files()) {
      const auto part = read(file);
      all.insert(all.end(), part.begin(), part.end());
      fs::remove(file);
    }
    expect_same(all, items);
  }
}

TEST_F(CaptureRecorderTest, RefusesAFileThatIsNoCaptureAndAFolderThatIsNotThere) {
  EXPECT_THROW(CaptureRecorder(folder_ / "none/hub.pcap", default_rig(), {}), Error);
  std::ofstream(folder_ / "text") << "no capture";
  EXPECT_THROW(CaptureRecorder(folder_ / "text", default_rig(), {}), Error);
}

TEST_F(CaptureRecorderTest, LeavesTheFileOfAnotherProgramAsItIs) {
  const fs::path file = folder_ / "hub.pcap";
  {
    CaptureRecorder recorder(folder_ / "own.pcap", default_rig(), {});
    for (const HubItem& item : test::simulated_items(0.1)) recorder.write(item);
    recorder.close();
    CaptureFile own(folder_ / "own.pcap");
    PcapWriter foreign(file, PcapMode::Grow);
    while (const Packet* packet = own.next()) {
      Bytes frame(packet->bytes.begin(), packet->bytes.end());
      frame[6] = 0;  // as a network card of some maker
      foreign.write(packet->time_ns, frame);
    }
    foreign.close();
  }
  const auto before = fs::file_size(file);
  EXPECT_THROW(CaptureRecorder(file, default_rig(), {}), Error);
  auto stage = test::StageDriver::of<RecordStage>({{"file", OptionValue(OptionScalar(file.string()))}});
  try {
    stage.check();
    FAIL() << "nothing is said before the recording";
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("hub.pcap is there already"));
  }
  EXPECT_EQ(fs::file_size(file), before);
  EXPECT_NO_THROW(CaptureRecorder(folder_ / "own.pcap", default_rig(), {}));
}

}  // namespace
}  // namespace crisp
