// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/bag/bag_stage.hpp"

#include <gmock/gmock.h>

#include "tests/grabbers/bag/bag_writer.hpp"
#include "tests/support/stage_driver.hpp"
#include "tests/support/temporary_folder.hpp"

namespace crisp {
namespace {

using test::StageDriver;
using testing::ElementsAre;
using testing::HasSubstr;

constexpr std::int64_t kBegin = 1'700'000'000'000'000'000;
constexpr std::int64_t kMs = 1'000'000;

class BagStageTest : public testing::Test {
 protected:
  BagStageTest() {
    rig_.lasers.resize(1);
    rig_.lasers[0] = {.name = "front", .mount = 0.5};
    rig_.plate.counts_per_revolution = 1'000'000;
    bag_.topics = {{"/scan", "sensor_msgs/LaserScan", test::kLaserScanDefinition},
                   {"/joints", "sensor_msgs/JointState", test::kJointStateDefinition},
                   {"/count", "std_msgs/Int32", "int32 data\n"}};
  }

  void add_scan(std::int64_t ms, std::vector<float> ranges, std::size_t topic = 0) {
    const std::int64_t stamp = kBegin + kMs * ms;
    bag_.messages.push_back({topic, stamp + 30 * kMs,
                             test::scan_bytes({.stamp_ns = stamp,
                                               .angle_min = 1,
                                               .angle_increment = -0.25F,
                                               .time_increment = 0.0009765625F,
                                               .scan_time = 0.025F,
                                               .ranges = std::move(ranges)},
                                              false)});
  }
  void add_joint(std::int64_t ms, double angle) {
    const std::int64_t stamp = kBegin + kMs * ms;
    bag_.messages.push_back({1, stamp + kMs, test::joints_bytes(stamp, {"x", "tilt"}, {9, angle}, false)});
  }

  StageDriver run(std::map<std::string, OptionValue> options = {}) {
    test::write_rosbag1(folder_ / "a.bag", bag_, "none");
    options.emplace("file", OptionScalar((folder_ / "a.bag").string()));
    auto stage = StageDriver::of<BagStage>(options);
    stage.run().rig = rig_;
    stage.feed();
    return stage;
  }
  std::string complaint() {
    try {
      run();
    } catch (const Error& error) {
      return error.what();
    }
    return "nothing";
  }

  test::TemporaryFolder folder_;
  test::TestBag bag_;
  Rig rig_;
};

TEST_F(BagStageTest, KeepsTheHeadersStampAndTheReceiptOfScans) {
  rig_.plate.joint = "tilt";
  add_scan(0, {1, 0, 2});
  add_scan(25, {1, 1, 1});
  const auto scans = run().given<Scan>();
  ASSERT_EQ(scans.size(), 2U);
  EXPECT_EQ(scans[1]->scan_time_us - scans[0]->scan_time_us, 25'000U);
  EXPECT_EQ(scans[1]->receipt_ns, kBegin + 55 * kMs);
  EXPECT_EQ(scans[0]->start_angle, 1);
  EXPECT_EQ(scans[0]->angle_step, -0.25);
  EXPECT_EQ(scans[0]->timing, BeamTiming::stated);
  EXPECT_EQ(scans[0]->beam_interval, 0.0009765625);
  EXPECT_THAT(scans[0]->echoes.at(0).ranges, ElementsAre(1, 0, 2));
}

TEST_F(BagStageTest, KeepsTheHeadersStampAndTheReceiptOfAngles) {
  rig_.plate.joint = "tilt";
  rig_.plate.direction = CountDirection::clockwise;
  add_joint(0, 0);
  add_joint(10, 0.25);
  const auto readings = run().given<PlateReading>();
  ASSERT_EQ(readings.size(), 2U);
  EXPECT_EQ(readings[1].get()->device_us - readings[0]->device_us, 10'000U);
  EXPECT_EQ(readings[1]->receipt_ns, kBegin + 11 * kMs);
  EXPECT_EQ(readings[1]->count, 39'789U);  // 0.25 / 2π of a million
}

TEST_F(BagStageTest, PlacesBeamsOnTheHeadersTime) {
  rig_.plate.joint = "tilt";
  add_joint(0, 0.5);
  add_scan(0, {1, 0, 2});
  add_joint(100, 1.5);
  auto stage = run();
  const auto beams = stage.given<Measurements>().at(0);
  EXPECT_THAT(beams->range, ElementsAre(1, 2));
  EXPECT_THAT(beams->time, ElementsAre(0, 2 * 0.0009765625));
  EXPECT_THAT(beams->mirror_angle, ElementsAre(0.5F, 0.0F));
  EXPECT_THAT(beams->beam, ElementsAre(0, 2));
  EXPECT_EQ(beams->epoch_ns, kBegin);
  const auto plate = stage.given<PlateTrajectory>().at(0);
  EXPECT_NEAR(plate->at(0.05)->angle, 1.0, 1e-5);
}

TEST_F(BagStageTest, TakesTheRigsTimeOffsetForTheFirstBeams) {
  rig_.plate.joint = "tilt";
  rig_.lasers[0].time_offset = -0.5;
  add_joint(0, 0.5);
  add_scan(1000, {1});
  add_joint(2000, 1.5);
  EXPECT_THAT(run().given<Measurements>().at(0)->time, ElementsAre(0.5));
}

TEST_F(BagStageTest, ReadsCountsOfATopicThatTheRigNames) {
  rig_.plate.topic = "/count";
  for (const std::int32_t count : {0, 250'000}) {
    bag_.messages.push_back({2, kBegin + kMs * count / 1000, test::RosBytes(false).put(count).bytes()});
  }
  auto stage = run();
  EXPECT_EQ(stage.given<PlateReading>().at(1)->count, 250'000U);
}

TEST_F(BagStageTest, CountsWhatIsLeftOut) {
  rig_.plate.joint = "tilt";
  add_scan(0, {1});
  add_scan(0, {1});
  add_scan(50, {1});
  bag_.messages.push_back({0, kBegin + 80 * kMs, "short"});
  add_scan(90, {1});
  const auto report = run({{"duration", OptionScalar(0.055)}}).report();
  EXPECT_EQ(report.counts.at("scans that are not later than the one before"), 1U);
  EXPECT_EQ(report.counts.at("messages that end before their content"), 1U);
  EXPECT_EQ(report.counts.at("messages outside of begin and duration"), 1U);
}

TEST_F(BagStageTest, TwoTopicsOfScansAreAnErrorUnlessTheRigNamesOne) {
  bag_.topics.push_back({"/other", "sensor_msgs/LaserScan", test::kLaserScanDefinition});
  add_scan(0, {1});
  add_scan(0, {2}, 3);
  EXPECT_THAT(complaint(), HasSubstr("both /scan and /other could be of front"));
  rig_.lasers[0].topic = "/other";
  EXPECT_THAT(run().given<Scan>().at(0)->echoes.at(0).ranges, ElementsAre(2));
}

TEST_F(BagStageTest, ARigOfSeveralLasersMustNameTheirTopics) {
  rig_.lasers.push_back({.name = "rear", .topic = "/rear"});
  auto stage = StageDriver::of<BagStage>({});
  stage.run().rig = rig_;
  EXPECT_THROW(stage.check(), Error);
}

TEST_F(BagStageTest, ReportsWhichTopicsThereAreWhereNoneIsTheRigs) {
  rig_.lasers[0].topic = "/tilt_scan";
  rig_.plate.topic = "/none";
  add_scan(0, {1});
  EXPECT_THAT(complaint(),
              HasSubstr("its topics are /count (std_msgs/Int32), /joints (sensor_msgs/JointState), /scan"));
}

}  // namespace
}  // namespace crisp
