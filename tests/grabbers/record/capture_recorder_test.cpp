// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/record/capture_recorder.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <fstream>
#include <thread>

#include <crisp/error.hpp>

#include "grabbers/capture/capture_file.hpp"
#include "grabbers/record/record_stage.hpp"
#include "tests/grabbers/record/capture_recorder_fixture.hpp"
#include "tests/support/simulated_items.hpp"
#include "tests/support/stage_driver.hpp"

namespace crisp {
namespace {

using namespace crisp::capture;
using namespace crisp::record;
using namespace crisp::simulate;
using namespace crisp::wire;

TEST_F(CaptureRecorderTest, IsReadBackItemForItemWithItsTimes) {
  const auto items = test::simulated_items(0.5);
  CaptureRecorder recorder(folder_ / "hub.pcap", default_rig(), {});
  for (const HubItem& item : items) recorder.write(item);
  recorder.close();
  expect_same(read(folder_ / "hub.pcap"), items);
}

TEST_F(CaptureRecorderTest, RecordsAnEncoderThatIsWiredToALaserInItsScansAlone) {
  Rig rig = default_rig();
  rig.plate.address = {};
  rig.plate.encoder_of = 0;
  CaptureRecorder recorder(folder_ / "hub.pcap", rig, {});
  for (const HubItem& item : test::simulated_items(0.2)) {
    const auto* scan = std::get_if<std::shared_ptr<const Scan>>(&item);
    if (scan == nullptr || (*scan)->laser != 0) continue;
    auto counted = std::make_shared<Scan>(**scan);
    counted->encoders = {{.position = 70'000U + counted->scan_counter}};
    recorder.write(PlateReading{.count = 1, .receipt_ns = counted->receipt_ns});
    recorder.write(std::shared_ptr<const Scan>(std::move(counted)));
  }
  recorder.close();
  CaptureReader reader(folder_ / "hub.pcap", rig);
  std::size_t scans = 0, readings = 0;
  std::uint32_t count = 0;
  while (const auto item = reader.next()) {
    if (const auto* reading = std::get_if<PlateReading>(&*item)) {
      ++readings;
      count = reading->count;
    } else {
      ++scans;
      EXPECT_EQ(count, 70'000U + std::get<std::shared_ptr<const Scan>>(*item)->scan_counter);
    }
  }
  EXPECT_GT(scans, 5U);
  EXPECT_EQ(readings, scans);
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
  ASSERT_EQ(stage.report().caveats.size(), 1U);
  EXPECT_THAT(stage.report().caveats[0],
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
       {RecorderSettings{.most_seconds = 0.2}, RecorderSettings{.max_bytes = 60'000}}) {
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

TEST_F(CaptureRecorderTest, ReportsWhyARecordingThatIsThereCannotBeRead) {
  constexpr uid_t kNobody = 65534;
  { CaptureRecorder recorder(folder_ / "hub.pcap", default_rig(), {}); }
  fs::permissions(folder_.path(), fs::perms::owner_all | fs::perms::group_exec | fs::perms::others_exec);
  fs::permissions(folder_ / "hub.pcap", fs::perms::none);
  const uid_t user = geteuid();
  if (user == 0 && seteuid(kNobody) != 0) GTEST_SKIP() << "root may read everything";
  std::string message;
  try {
    refuse_foreign(folder_ / "hub.pcap");
  } catch (const Error& error) {
    message = error.message();
  }
  ASSERT_EQ(seteuid(user), 0);
  EXPECT_EQ(message, "cannot read " + (folder_ / "hub.pcap").string() + ": Permission denied");
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
    FAIL() << "nothing is reported before the recording";
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("hub.pcap exists and is of another program"));
  }
  EXPECT_EQ(fs::file_size(file), before);
  EXPECT_NO_THROW(CaptureRecorder(folder_ / "own.pcap", default_rig(), {}));
}

}  // namespace
}  // namespace crisp
