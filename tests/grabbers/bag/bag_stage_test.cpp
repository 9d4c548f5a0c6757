// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include <array>
#include <cmath>

#include "tests/grabbers/bag/bag_fixture.hpp"

namespace crisp {
namespace {

using namespace crisp::bag;
using test::kBegin;
using test::kMs;
using test::StageDriver;
using testing::ElementsAre;
using testing::HasSubstr;

class BagStageTest : public test::BagFixture {};

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

TEST_F(BagStageTest, UsesTheRigsChoiceOfAMultiEchoScansEchoes) {
  rig_.plate.joint = "tilt";
  bag_.topics[0] = {"/scan", "sensor_msgs/MultiEchoLaserScan", test::kMultiEchoDefinition};
  add_joint(0, 0.5);
  test::RosBytes scan(false);
  scan.header(kBegin);
  for (const float number : {1.0F, 2.0F, 0.25F, 0.0009765625F, 0.025F, 0.5F, 100.0F}) scan.put(number);
  scan.put(std::uint32_t{3});  // beams: two echoes, one, and the second alone
  for (const auto& ranges : {std::vector<float>{1, 3}, {2}, {0, 4}}) scan.list(ranges);
  scan.put(std::uint32_t{3});
  for (const auto& intensities : {std::vector<float>{10, 30}, {20}, {0, 40}}) scan.list(intensities);
  bag_.messages.push_back({0, kBegin + 30 * kMs, scan.bytes()});
  add_joint(100, 1.5);
  const auto beams = [&](EchoChoice choice) {
    rig_.lasers[0].echo = choice;
    return run().given<Measurements>().at(0);
  };
  EXPECT_THAT(beams(EchoChoice::first)->range, ElementsAre(1, 2, 4));
  EXPECT_THAT(beams(EchoChoice::last)->range, ElementsAre(3, 2, 4));
  EXPECT_THAT(beams(EchoChoice::strongest)->remission, ElementsAre(30, 20, 40));
  const auto all = beams(EchoChoice::all);
  EXPECT_THAT(all->range, ElementsAre(1, 3, 2, 4));
  EXPECT_THAT(all->beam, ElementsAre(0, 0, 1, 2));
  EXPECT_THAT(all->time, ElementsAre(0, 0, 0.0009765625, 2 * 0.0009765625));
  EXPECT_EQ(run().report().counts.at("front: beams with a later echo only"), 1U);
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

constexpr const char* kTransformsDefinition =
    "geometry_msgs/TransformStamped[] transforms\n"
    "================================================================================\n"
    "MSG: geometry_msgs/TransformStamped\nHeader header\nstring child_frame_id\nTransform transform\n"
    "================================================================================\n"
    "MSG: std_msgs/Header\nuint32 seq\ntime stamp\nstring frame_id\n"
    "================================================================================\n"
    "MSG: geometry_msgs/Transform\nVector3 translation\nQuaternion rotation\n"
    "================================================================================\n"
    "MSG: geometry_msgs/Vector3\nfloat64 x\nfloat64 y\nfloat64 z\n"
    "================================================================================\n"
    "MSG: geometry_msgs/Quaternion\nfloat64 x\nfloat64 y\nfloat64 z\nfloat64 w\n";

/// Transforms of the base, and of a frame that is turned by a quarter about z, and then by `tilt` about y.
std::string transforms(std::int64_t stamp_ns, double tilt) {
  constexpr double kHalf = 0.70710678118654752;  // √½
  const double s = std::sin(tilt / 2), c = std::cos(tilt / 2);
  test::RosBytes bytes(false);
  bytes.put(std::uint32_t{2});
  for (const bool is_base : {true, false}) {
    bytes.header(stamp_ns + (is_base ? 5 * kMs : 0)).text(is_base ? "base" : "tilt");
    for (int i = 0; i < 3; ++i) bytes.put(1.5);
    // (0, 0, √½, √½)·(0, s, 0, c) after Hamilton
    const std::array<double, 4> of_frame = {-kHalf * s, kHalf * s, kHalf * c, kHalf * c};
    for (const double part : is_base ? std::array<double, 4>{0, 0, 0, 1} : of_frame) bytes.put(part);
  }
  return bytes.bytes();
}

TEST_F(BagStageTest, ReadsTheAngleOfAFrameOfTf) {
  rig_.plate.topic = "/tf";
  rig_.plate.joint = "tilt";
  bag_.topics.push_back({"/tf", "tf2_msgs/TFMessage", kTransformsDefinition});
  const std::vector<double> angles = {0.25, 0.5, -0.75, -3, -4, 2 * 3.14159265358979 - 6};
  for (std::size_t k = 0; k < angles.size(); ++k) {
    const std::int64_t stamp = kBegin + static_cast<std::int64_t>(k) * 100 * kMs;
    bag_.messages.push_back({3, stamp + kMs, transforms(stamp, angles[k])});
  }
  auto stage = run();
  const auto plate = stage.given<PlateTrajectory>().at(0);
  for (std::size_t k = 0; k + 1 < angles.size(); ++k) {
    EXPECT_NEAR(plate->at(0.1 * static_cast<double>(k))->angle, angles[k] - angles[0], 1e-5) << k;
  }
  EXPECT_NEAR(plate->at(0.5)->angle, -6 - angles[0], 1e-5) << "whole turns are continued";
  rig_.plate.joint = "";
  EXPECT_THAT(complaint(), HasSubstr("name the frame that turns as 'joint'"));
}

TEST_F(BagStageTest, ReadsTheAngleOfAQuaternionThatTheRigNames) {
  rig_.plate.topic = "/turn";
  rig_.plate.field = "quaternion";
  bag_.topics.push_back(
      {"/turn", "geometry_msgs/QuaternionStamped",
       "Header header\nQuaternion quaternion\n===\nMSG: std_msgs/Header\nuint32 seq\ntime stamp\n"
       "string frame_id\n===\nMSG: geometry_msgs/Quaternion\nfloat64 x\nfloat64 y\nfloat64 z\n"
       "float64 w\n"});
  for (const int k : {0, 1, 2}) {
    test::RosBytes bytes(false);
    bytes.header(kBegin + k * 100 * kMs);
    for (const double part : {0.0, 0.0, -2 * std::sin(0.2 * k), -2 * std::cos(0.2 * k)}) bytes.put(part);
    bag_.messages.push_back({3, kBegin + k * 100 * kMs, bytes.bytes()});
  }
  test::RosBytes none(false);
  none.header(kBegin + 300 * kMs);
  for (int i = 0; i < 4; ++i) none.put(0.0);
  bag_.messages.push_back({3, kBegin + 300 * kMs, none.bytes()});
  auto stage = run();
  EXPECT_NEAR(stage.given<PlateTrajectory>().at(0)->at(0.2)->angle, 0.8, 1e-5);
  EXPECT_EQ(stage.report().counts.at("rotations that are no unit quaternions"), 1U);
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
