// SPDX-License-Identifier: BSD-3-Clause
// Incomplete recordings, and runs with wrong inputs: losses are named, errors are reported, and nothing
// half-written remains.
#include <gmock/gmock.h>
#include <sys/wait.h>

#include <algorithm>
#include <cstdlib>

#include "tests/end_to_end/pipeline_fixture.hpp"
#include "tests/end_to_end/room.hpp"
#include "tests/support/source_dir.hpp"

namespace crisp {
namespace {

using namespace crisp::app;
using test::bytes_of;
using test::Outcome;
using test::put_bytes;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

class Faults : public testing::Test {
 protected:
  void simulate(std::vector<std::string> options) {
    options.emplace_back("lasers.step=2deg");
    options.push_back("scene_file=" + test::write_room(fixture_ / "room.yaml").string());
    fixture_.simulate("made", options);
  }
  Outcome assemble() { return fixture_.assemble("made", "out"); }
  Outcome assemble_with_rig(const std::string& yaml) {
    put_bytes(fixture_ / "rig.yaml", yaml);
    return fixture_.run("assemble.yaml", fixture_ / "made/hub.pcap", "out",
                        {"calibration=" + (fixture_ / "made/truth.yaml").string()}, fixture_ / "rig.yaml");
  }
  std::string default_rig_but(const std::string& what, const std::string& with) const {
    std::string yaml = bytes_of(source_dir() + "/configs/rig.yaml");
    return yaml.replace(yaml.find(what), what.size(), with);
  }

  static void expect_on_the_walls(const Outcome& outcome) {
    ASSERT_NE(outcome.cloud, nullptr) << outcome.console;
    const auto all = test::against_room(*outcome.cloud, {0.2, 0.2, 0.2});
    EXPECT_LT(test::rms(all, [](const auto& each) { return each.distance; }), 0.013);
  }
  static void expect_nothing_but(const std::string& error, const Outcome& outcome) {
    EXPECT_NE(outcome.status, ExitStatus::done);
    EXPECT_THAT(outcome.console, AllOf(HasSubstr("error: "), HasSubstr(error)));
    EXPECT_THAT(outcome.files, ElementsAre("summary.json"));
    EXPECT_THAT(outcome.summary.value("error", ""), HasSubstr(error));
  }
  static std::size_t points_of(const Outcome& outcome, unsigned laser) {
    return static_cast<std::size_t>(std::count_if(outcome.cloud->begin(), outcome.cloud->end(),
                                                  [&](const Point& point) { return point.laser == laser; }));
  }

  test::PipelineFixture fixture_;
};

TEST_F(Faults, LostTelegramsAndReadingsAreCountedByDevice) {
  simulate({"duration=4s", "faults.lost_scans=0.1", "faults.lost_readings=0.02"});
  const Outcome outcome = assemble();
  EXPECT_EQ(outcome.status, ExitStatus::done) << outcome.console;
  expect_on_the_walls(outcome);
  // 200 scans a laser, 2000 readings: binomial, 5 standard deviations
  for (const std::string laser : {"laser1", "laser2", "laser3"}) {
    const auto lost = outcome.count("grabber.capture", laser + ": lost telegrams, by their counter");
    EXPECT_NEAR(static_cast<double>(lost), 20, 5 * 4.3) << laser;
    EXPECT_EQ(outcome.count("clock.convex_hull", laser + ": telegrams lost"), lost);
  }
  const auto lost = outcome.count("grabber.capture", "plate: lost readings, by their sequence number");
  EXPECT_NEAR(static_cast<double>(lost), 40, 5 * 6.3);
}

TEST_F(Faults, LostRepeatedAndDamagedPacketsOfTheCaptureLeaveASoundCloud) {
  simulate({"duration=4s", "faults.lost_frames=0.02", "faults.repeated_frames=0.02",
            "faults.damaged_frames=0.02"});
  const Outcome outcome = assemble();
  EXPECT_EQ(outcome.status, ExitStatus::done) << outcome.console;
  expect_on_the_walls(outcome);
  EXPECT_GT(outcome.losses("grabber.capture"), 20U);
}

TEST_F(Faults, ALaserThatIsSilentForASecondLeavesAGapOfItsOwn) {
  simulate({"duration=4s", "faults.silences=laser2@1.5s+1s"});
  const Outcome outcome = assemble();
  EXPECT_EQ(outcome.status, ExitStatus::done);
  EXPECT_THAT(outcome.console, HasSubstr("laser2: silent 1 time(s) for a second or more, longest 1.0 s"));
  expect_on_the_walls(outcome);
  EXPECT_NEAR(static_cast<double>(points_of(outcome, 1)), 0.75 * static_cast<double>(points_of(outcome, 0)),
              2.0 * 136);
}

TEST_F(Faults, ThePlatesSilenceLeavesAGapInTheCloudAndIsReported) {
  simulate({"duration=4s", "faults.silences=plate@1.5s+1s"});
  const Outcome outcome = assemble();
  EXPECT_EQ(outcome.status, ExitStatus::done);
  EXPECT_THAT(outcome.console,
              AllOf(HasSubstr("plate: silent 1 time(s)"), HasSubstr("% of the beams are not in the cloud")));
  expect_on_the_walls(outcome);
  // A second's scans of three lasers, 136 beams each, within a scan of each.
  const auto outside = outcome.count("assemble.deskew", "beams outside the encoder readings");
  EXPECT_NEAR(static_cast<double>(outside), 50 * 3 * 136, 3 * 136 * 5);
}

TEST_F(Faults, WithoutOneLaserTheOthersStillMakeACloud) {
  simulate({"duration=2s", "faults.silences=laser2@0s+100s"});
  const Outcome outcome = assemble();
  EXPECT_EQ(outcome.status, ExitStatus::done);
  EXPECT_THAT(outcome.console, HasSubstr("laser2"));
  expect_on_the_walls(outcome);
  EXPECT_EQ(points_of(outcome, 1), 0U);
  EXPECT_GT(points_of(outcome, 2), 0U);
}

TEST_F(Faults, WithoutThePlateOrAnyLaserThereIsNoCloud) {
  simulate({"duration=1s", "faults.silences=plate@0s+100s"});  // a few readings come before
  expect_nothing_but("could be placed: no encoder readings cover their times", assemble());
  simulate({"duration=1s", "faults.silences=plate@-9s+100s"});
  expect_nothing_but("there is no encoder reading", assemble());
  simulate({"duration=1s", "faults.silences=[laser1@0s+100s, laser2@0s+100s, laser3@0s+100s]"});
  expect_nothing_but("there is no scan of any laser", assemble());
}

TEST_F(Faults, AResetOfADevicesClockIsFoundAndTheCloudStaysSound) {
  for (const std::string device : {"laser1", "plate"}) {
    simulate({"duration=6s", "faults.restarts=" + device + "@3s"});
    const Outcome outcome = assemble();
    EXPECT_EQ(outcome.status, ExitStatus::done) << outcome.console;
    EXPECT_THAT(outcome.console, HasSubstr(device + ": its clock was reset 1 time(s)"));
    EXPECT_EQ(outcome.count("clock.convex_hull", device + ": clock resets"), 1U);
    if (outcome.cloud) expect_on_the_walls(outcome);
  }
}

TEST_F(Faults, ARigOfOtherAddressesNamesTheSendersOfTheCapture) {
  simulate({"duration=1s"});
  const Outcome moved = assemble_with_rig(default_rig_but("192.168.0.2", "192.168.7.2"));
  EXPECT_EQ(moved.status, ExitStatus::not_trusted);
  EXPECT_THAT(
      moved.console,
      AllOf(HasSubstr("holds nothing of laser2 (192.168.7.2"),
            HasSubstr("not in the rig: laser at 192.168.0.2"),
            HasSubstr(
                "there is no data of laser2 (192.168.7.2), but of an unknown laser at 192.168.0.2:2112")));
  EXPECT_EQ(points_of(moved, 1), 0U);
  const Outcome unheard = assemble_with_rig(default_rig_but("port: 4000", "port: 4001"));
  expect_nothing_but("there is no encoder reading", unheard);
  EXPECT_THAT(unheard.console, HasSubstr("not in the rig: plate at 192.168.0.10:4000"));
}

TEST_F(Faults, ARigThatIsWrongIsRefusedWithThePlace) {
  simulate({"duration=1s"});
  const Outcome outcome = assemble_with_rig(default_rig_but("mount: 45deg", "mount: 45Hz"));
  EXPECT_EQ(outcome.status, ExitStatus::misused);
  EXPECT_THAT(outcome.console, HasSubstr("rig.yaml:9:12: error: "));
  EXPECT_THAT(outcome.files, IsEmpty());
  expect_nothing_but("the calibration has no laser 'roof', which the rig has",
                     assemble_with_rig(default_rig_but("laser3:", "roof:")));
}

/// The largest file that the shell allows stands for a disk with no more room: writing fails in its midst.
TEST_F(Faults, ADiskThatIsFullLeavesNothingHalfWritten) {
  simulate({"duration=2s"});
  const auto crisp = [&](const std::string& kilobytes) {
    const std::string command = "ulimit -f " + kilobytes + "; exec " CRISP_PROGRAM " run " + source_dir() +
                                "/configs/assemble.yaml --quiet -i " + (fixture_ / "made/hub.pcap").string() +
                                " -o " + (fixture_ / "full").string() +
                                " --set calibration=" + (fixture_ / "made/truth.yaml").string() + " 2> " +
                                (fixture_ / "console").string();
    put_bytes(fixture_ / "full.sh", command);
    return WEXITSTATUS(std::system(("bash " + (fixture_ / "full.sh").string()).c_str()));
  };
  EXPECT_EQ(crisp("100"), 1);
  EXPECT_THAT(bytes_of(fixture_ / "console"),
              AllOf(HasSubstr("error: write.pcd: cannot write"), HasSubstr("File too large"),
                    HasSubstr("make room on the disk")));
  EXPECT_THAT(bytes_of(fixture_ / "full/summary.json"), HasSubstr("File too large"));
  std::filesystem::remove(fixture_ / "full/summary.json");
  EXPECT_TRUE(std::filesystem::is_empty(fixture_ / "full"));
  EXPECT_EQ(crisp("100000"), 0) << bytes_of(fixture_ / "console");
  EXPECT_TRUE(std::filesystem::exists(fixture_ / "full/cloud.pcd"));
}

TEST_F(Faults, AnOutputThatIsNoFolderIsRefusedAtOnce) {
  simulate({"duration=1s"});
  const Outcome outcome = fixture_.assemble("made", "made/hub.pcap/out");
  EXPECT_EQ(outcome.status, ExitStatus::misused);
  EXPECT_THAT(outcome.console, HasSubstr("cannot write into the folder"));
  EXPECT_THAT(fixture_.assemble("made", "none", fixture_ / "none.pcap").console,
              HasSubstr("there is no input"));
}

}  // namespace
}  // namespace crisp
