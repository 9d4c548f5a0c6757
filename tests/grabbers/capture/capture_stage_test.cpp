// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include <atomic>
#include <fstream>
#include <utility>

#include <crisp/error.hpp>
#include <crisp/pipeline.hpp>
#include <crisp/runner.hpp>

#include "grabbers/capture/register.hpp"
#include "tests/grabbers/capture/scenario.hpp"
#include "tests/grabbers/capture/temporary_folder.hpp"

namespace crisp {
namespace {

using namespace crisp::capture;
using namespace crisp::wire;
using testing::Contains;
using testing::HasSubstr;

/// Takes what the capture gives.
struct Taker final : Stage {
  static inline std::vector<std::string> items;
  static inline std::atomic<bool>* stop = nullptr;
  static void describe(StageDescription<Taker>& d) {
    d.name("test.taker").summary("takes all").takes<Scan>().takes<PlateReading>();
  }
  void process(const Inputs& in, Outputs&, Context&) override {
    if (const auto scan = in.share<Scan>()) items.push_back(crisp::describe(HubItem(scan)));
    if (const auto* reading = in.find<PlateReading>()) items.push_back(crisp::describe(HubItem(*reading)));
    if (stop != nullptr) *stop = true;
  }
};

class CaptureStageTest : public testing::Test {
 protected:
  void SetUp() override {
    Taker::items.clear();
    Taker::stop = nullptr;
    register_capture(registrar_);
    registrar_.stage<Taker>();
    run_.registrar = &registrar_;
    write_file(folder_ / "hub.pcap", pcap_file(scenario_.frames()));
  }

  NodeResult run(const std::string& options, const RunHooks& hooks = {}) {
    std::ofstream(folder_ / "pipeline.yaml") << "crisp: 1\npipeline:\n  - stage: grabber.capture\n    with: {"
                                             << options << "}\n  - stage: test.taker\n";
    auto loaded = load_pipeline(folder_ / "pipeline.yaml", {}, run_);
    run_.rig = rig_;
    return run_pipeline(loaded.pipeline, run_, hooks).at(0);
  }
  std::string complaint(const std::string& options) {
    try {
      run(options);
    } catch (const Error& error) {
      return error.what();
    }
    return "nothing";
  }
  std::string file() const { return "file: " + (folder_ / "hub.pcap").string(); }

  Scenario scenario_;
  TemporaryFolder folder_;
  Registrar registrar_;
  RunSettings run_;
  Rig rig_ = default_rig();
};

TEST_F(CaptureStageTest, GivesWhatTheCaptureHoldsAndReportsIt) {
  const auto result = run(file());
  EXPECT_EQ(Taker::items, describe(scenario_.items()));
  EXPECT_EQ(result.report.section["devices"][0]["items"], 10);
  EXPECT_EQ(result.report.section["devices"][3]["kind"], "plate");
  EXPECT_THAT(result.report.lines, Contains(HasSubstr("laser1 (192.168.0.1)")));
  EXPECT_THAT(result.report.warnings, testing::ElementsAre(HasSubstr("holds nothing of laser3")));
  EXPECT_THAT(result.report.read, testing::ElementsAre(folder_ / "hub.pcap"));
  EXPECT_TRUE(result.report.counts.empty());
}

TEST_F(CaptureStageTest, GivesAndReportsTheSameOnSeveralThreads) {
  const auto one = run(file());
  const auto items = std::exchange(Taker::items, {});
  run_.threads = 4;
  const auto several = run(file());
  EXPECT_EQ(Taker::items, items);
  EXPECT_EQ(several.report.section, one.report.section);
  EXPECT_EQ(several.report.counts, one.report.counts);
}

TEST_F(CaptureStageTest, NamesLossesByTheirDevice) {
  auto frames = scenario_.frames();
  auto damaged = pcap_file(frames);
  damaged.resize(damaged.size() - 10);
  write_file(folder_ / "hub.pcap", damaged);
  const auto result = run(file());
  EXPECT_THAT(result.report.counts,
              Contains(testing::Pair("bytes of a record truncated by the end of the file", testing::Gt(0U))));
}

TEST_F(CaptureStageTest, GivesAPartOfTheCapture) {
  run(file() + ", begin: 540ms, duration: 100ms");
  // The capture begins with a handshake 0.50008 s before kStart: 0.04 s … 0.14 s of the scenario are left.
  std::vector<std::string> expected;
  for (const auto& item : scenario_.items()) {
    const auto since = receipt_ns(item) - (kStart - 500'080'000);
    if (since >= 540'000'000 && since < 640'000'000) expected.push_back(describe(item));
  }
  EXPECT_GT(expected.size(), 50U);
  EXPECT_EQ(Taker::items, expected);
}

TEST_F(CaptureStageTest, ReportsWhatItFoundInsteadOfTheRigsDevices) {
  for (auto& laser : rig_.lasers) laser.address.ip.insert(0, "1");  // 1192.168…
  EXPECT_THAT(complaint(file()), HasSubstr("no IP address"));
  rig_.lasers[1].address.ip.clear();
  rig_.lasers[0].address.ip = "10.0.0.1";
  EXPECT_THAT(complaint(file()), HasSubstr("laser2 has no address in the rig"));
  for (std::size_t i = 0; i < 3; ++i) rig_.lasers[i].address.ip = "10.0.0." + std::to_string(i + 1);
  rig_.plate.address.ip = "10.0.0.10";
  EXPECT_THAT(complaint(file()),
              HasSubstr("laser at 192.168.0.1:2112, laser at 192.168.0.2:2112, plate at 192.168.0.10:4000"));
}

TEST_F(CaptureStageTest, WarnsOfDevicesThatTheRigDoesNotKnow) {
  rig_.lasers.pop_back();
  rig_.lasers.pop_back();
  const auto result = run(file());
  EXPECT_THAT(result.report.warnings, Contains("not in the rig: laser at 192.168.0.2:2112"));
  EXPECT_EQ(result.report.counts.at("items of a laser at 192.168.0.2:2112 that is not in the rig"), 10U);
}

TEST_F(CaptureStageTest, MarksALaserOfAnotherAddressUntrusted) {
  rig_.lasers[1].address.ip = "192.168.0.20";
  const auto result = run(file());
  EXPECT_THAT(
      result.report.caveats,
      testing::ElementsAre(
          "there is no data of laser2 (192.168.0.20), but of an unknown laser at 192.168.0.2:2112; correct the addresses and ports in the rig",
          HasSubstr("there is no data of laser3")));
}

TEST_F(CaptureStageTest, MarksTwoLasersOfOneAddressUntrusted) {
  scenario_.same_address = true;
  write_file(folder_ / "hub.pcap", pcap_file(scenario_.frames()));
  const auto result = run(file());
  EXPECT_THAT(
      result.report.caveats,
      Contains(HasSubstr("laser1: 2 units (serial numbers 1000, 1001) send by turns from 192.168.0.1")));
}

TEST_F(CaptureStageTest, NamesALaserOfWhichScansCannotBeRead) {
  scenario_.scans = 200;
  const auto run_with = [&](std::size_t of_100) {
    scenario_.is_unreadable = [=](std::size_t k) { return k % 100 < of_100; };
    write_file(folder_ / "hub.pcap", pcap_file(scenario_.frames()));
    return run(file()).report;
  };
  EXPECT_THAT(run_with(1).warnings, testing::Not(Contains(HasSubstr("laser2"))));
  const auto half = run_with(50);
  EXPECT_THAT(
      half.warnings,
      Contains(HasSubstr(
          "hub.pcap: 50.0 % of the scans of laser2 (192.168.0.2) (100 of 200) are unusable: 100 scan telegrams that hold no scan: channels with different angles")));
  EXPECT_THAT(half.warnings, testing::Not(Contains(HasSubstr("scans of laser1"))));
  EXPECT_TRUE(half.caveats.empty());
  const auto nearly_all = run_with(99);
  EXPECT_THAT(nearly_all.caveats, testing::ElementsAre(HasSubstr("99.0 % of the scans of laser2")));
}

TEST_F(CaptureStageTest, ReportsWhatIsLeftOfACaptureThatIsShorterThanBegin) {
  EXPECT_THAT(complaint(file() + ", begin: 100s"),
              testing::AllOf(HasSubstr("begin and duration select nothing of " +
                                       (folder_ / "hub.pcap").string() + ", which ends after 0.7 s"),
                             HasSubstr("reduce begin")));
}

TEST_F(CaptureStageTest, NamesTheKindOfAFileThatIsNoCapture) {
  write_file(folder_ / "hub.pcap", Bytes{0x1F, 0x8B, 8, 0, 0, 0, 0, 0, 0});
  EXPECT_THAT(complaint(file()), HasSubstr("hub.pcap cannot be decompressed from byte 0 on"));
  const std::string pcd = "# .PCD v0.7 - Point Cloud Data file format\n";
  write_file(folder_ / "hub.pcap", Bytes(pcd.begin(), pcd.end()));
  EXPECT_THAT(complaint(file()), HasSubstr("hub.pcap is a PCD file, not a capture; grabber.pcd reads"));
}

TEST_F(CaptureStageTest, WarnsOfWhatALaserSentThatNeverCame) {
  scenario_.scans = 300;
  auto frames = scenario_.frames();
  std::size_t of_laser2 = 0;
  std::erase_if(frames, [&](const Frame& frame) {  // every 50th packet of laser2
    return frame.bytes[29] == 2 && frame.bytes.size() > 60 && ++of_laser2 % 50 == 0;
  });
  write_file(folder_ / "hub.pcap", pcap_file(frames));
  const auto result = run(file());
  EXPECT_THAT(result.report.warnings,
              Contains(HasSubstr(
                  "hub.pcap: 2.0 % of the telegrams of laser2 (192.168.0.2) (6 of 300 scans) were lost")));
  EXPECT_THAT(result.report.warnings, testing::Not(Contains(HasSubstr("laser1"))));
}

TEST_F(CaptureStageTest, WarnsOfAFileThatEndsWithinARecord) {
  auto cut = pcap_file(scenario_.frames());
  cut.resize(cut.size() - 10);
  write_file(folder_ / "hub.pcap", cut);
  EXPECT_THAT(run(file()).report.warnings, Contains(HasSubstr("hub.pcap: the file ends ")));
}

TEST_F(CaptureStageTest, WarnsOfAFileThatIsDamaged) {
  auto damaged = pcap_file(scenario_.frames());
  const auto begin = damaged.begin() + static_cast<std::ptrdiff_t>(damaged.size() / 2);
  std::fill(begin, begin + static_cast<std::ptrdiff_t>(damaged.size() / 20), std::uint8_t{0xFF});
  write_file(folder_ / "hub.pcap", damaged);
  EXPECT_THAT(run(file()).report.warnings, Contains(HasSubstr("% of the file")));
}

class CaptureFolder : public CaptureStageTest {
 protected:
  CaptureFolder() {
    std::filesystem::create_directory(captures());
    write_file(captures() / "notes.txt", Bytes{'r', 'o', 'o', 'm'});
  }
  std::filesystem::path captures() const { return folder_ / "captures"; }
  std::string file() const { return "file: " + captures().string(); }
  /// The scenario's frames, some seconds later.
  Bytes later(std::int64_t seconds) const {
    auto frames = scenario_.frames();
    for (auto& frame : frames) frame.time_ns += seconds * 1'000'000'000;
    return pcap_file(frames);
  }
};

TEST_F(CaptureFolder, ItsCapturesComeInTheOrderOfTheirPackets) {
  write_file(captures() / "a.pcap", later(100));
  write_file(captures() / "b.pcap", later(0));
  const auto result = run(file());
  const auto items = scenario_.items();
  ASSERT_EQ(Taker::items.size(), 2 * items.size());
  EXPECT_EQ(
      std::vector(Taker::items.begin(), Taker::items.begin() + static_cast<std::ptrdiff_t>(items.size())),
      describe(items));
  EXPECT_THAT(result.report.read, testing::ElementsAre(captures() / "b.pcap", captures() / "a.pcap"));
  ASSERT_EQ(result.report.section["captures"].size(), 2U);
  EXPECT_EQ(result.report.section["captures"][1]["file"], (captures() / "a.pcap").string());
}

TEST_F(CaptureFolder, CapturesOfTheSameTimeAreRefused) {
  write_file(captures() / "a.pcap", later(0));
  write_file(captures() / "b.pcap", later(0));
  EXPECT_THAT(complaint(file()), HasSubstr("begins before a.pcap ends"));
}

TEST_F(CaptureFolder, WarnsOfEachThatCannotBeRead) {
  write_file(captures() / "a.pcap", later(0));
  write_file(captures() / "b.pcap", Bytes(1000, 7));
  write_file(captures() / "c.pcap", Bytes(1, 7));
  auto cut = later(100);
  cut.resize(10);
  write_file(captures() / "without_a_suffix", cut);
  write_file(captures() / "empty.PCAPNG", Bytes());
  write_file(captures() / "no_packets.cap", pcap_file({}));
  const auto result = run(file());
  EXPECT_EQ(Taker::items, describe(scenario_.items()));
  EXPECT_THAT(
      result.report.warnings,
      testing::IsSupersetOf(
          {HasSubstr("b.pcap is neither pcap nor pcapng"), HasSubstr("c.pcap is neither pcap nor pcapng"),
           HasSubstr("without_a_suffix ends within its header"), HasSubstr("empty.PCAPNG is empty"),
           HasSubstr("no_packets.cap holds no packet")}));
  EXPECT_THAT(result.report.warnings, testing::Not(Contains(HasSubstr("notes.txt"))));
}

TEST_F(CaptureFolder, OneWithoutAnyThatCanBeReadIsRefusedWithTheReasons) {
  write_file(captures() / "b.pcap", Bytes(1000, 7));
  EXPECT_THAT(complaint(file()), HasSubstr("b.pcap is neither pcap nor pcapng"));
}

TEST_F(CaptureFolder, OneWithoutCapturesIsRefused) {
  EXPECT_THAT(complaint(file()), HasSubstr("is a folder without any capture"));
}

TEST_F(CaptureStageTest, ReportsThatTheFileIsMissing) {
  EXPECT_THAT(complaint("file: nowhere.pcap"), HasSubstr("nowhere.pcap: No such file or directory"));
  EXPECT_THAT(complaint(""), HasSubstr("file"));
}

TEST_F(CaptureStageTest, StopsWhenItIsInterrupted) {
  std::atomic<bool> stop = false;
  Taker::stop = &stop;
  EXPECT_ANY_THROW(run(file(), {.stop = &stop}));
  EXPECT_EQ(Taker::items.size(), 1U);
}

}  // namespace
}  // namespace crisp
