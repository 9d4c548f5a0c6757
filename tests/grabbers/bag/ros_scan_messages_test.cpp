// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/bag/ros_scan_messages.hpp"

#include <gmock/gmock.h>

#include <limits>
#include <numbers>

#include <crisp/error.hpp>

#include "grabbers/bag/byte_cursor.hpp"
#include "tests/grabbers/bag/bag_writer.hpp"

namespace crisp {
namespace {

using namespace crisp::bag;
using testing::ElementsAre;

constexpr std::int64_t kStamp = 1'700'000'000'987'654'321;

BagConnection connection(const std::string& type, const std::string& definition, RosEncoding encoding) {
  return {.topic = "/topic", .type = type, .definition = definition, .encoding = encoding};
}

class ScanMessages : public testing::TestWithParam<bool> {
 protected:
  RosEncoding encoding() const { return GetParam() ? RosEncoding::cdr : RosEncoding::ros1; }
};
INSTANTIATE_TEST_SUITE_P(InBothEncodings, ScanMessages, testing::Bool());

TEST_P(ScanMessages, AreReadWithTheirStampAnglesAndTimes) {
  const auto decoder = ScanDecoder::of(
      connection("sensor_msgs/LaserScan", GetParam() ? "" : test::kLaserScanDefinition, encoding()));
  ASSERT_TRUE(decoder);
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  constexpr float kInf = std::numeric_limits<float>::infinity();
  const auto scan = decoder->decode(test::scan_bytes({.stamp_ns = kStamp,
                                                      .angle_min = -1.5F,
                                                      .angle_increment = -0.25F,
                                                      .time_increment = 0.001F,
                                                      .scan_time = 0.025F,
                                                      .range_min = 0.1F,
                                                      .range_max = 30,
                                                      .ranges = {1, kNan, kInf, 0, -1, 0.05F, 31, 30, 0.1F},
                                                      .intensities = {1, 2, 3, 4, 5, 6, 7, 8, 9}},
                                                     GetParam()));
  EXPECT_EQ(scan.stamp_ns, kStamp);
  EXPECT_EQ(scan.angle_min, -1.5);
  EXPECT_EQ(scan.angle_increment, -0.25);
  EXPECT_EQ(scan.time_increment, 0.001F);
  EXPECT_EQ(scan.scan_time, 0.025F);
  ASSERT_EQ(scan.echoes.size(), 1U);
  EXPECT_THAT(scan.echoes[0].ranges, ElementsAre(1, 0, 0, 0, 0, 0, 0, 30, 0.1F));
  EXPECT_THAT(scan.echoes[0].remissions, ElementsAre(1, 2, 3, 4, 5, 6, 7, 8, 9));
}

TEST_P(ScanMessages, OfSeveralEchoesBecomeAListForEach) {
  const auto decoder = ScanDecoder::of(
      connection("sensor_msgs/MultiEchoLaserScan", GetParam() ? "" : test::kMultiEchoDefinition, encoding()));
  ASSERT_TRUE(decoder);
  test::RosBytes bytes(GetParam());
  bytes.header(kStamp);
  for (const float value : {0.0F, 0.2F, 0.1F, 0.0F, 0.1F, 0.0F, 30.0F}) bytes.put(value);
  bytes.put(std::uint32_t{3}).list<float>({1, 2}).list<float>({}).list<float>({3});
  bytes.put(std::uint32_t{3}).list<float>({10, 20}).list<float>({}).list<float>({30});
  const auto scan = decoder->decode(bytes.bytes());
  ASSERT_EQ(scan.echoes.size(), 2U);
  EXPECT_THAT(scan.echoes[0].ranges, ElementsAre(1, 0, 3));
  EXPECT_THAT(scan.echoes[1].ranges, ElementsAre(2, 0, 0));
  EXPECT_THAT(scan.echoes[0].remissions, ElementsAre(10, 0, 30));
}

TEST_P(ScanMessages, WithAnAngleThatIsNoNumberAreRefused) {
  const auto decoder = ScanDecoder::of(
      connection("sensor_msgs/LaserScan", GetParam() ? "" : test::kLaserScanDefinition, encoding()));
  const auto bytes = test::scan_bytes({.angle_min = std::numeric_limits<float>::quiet_NaN()}, GetParam());
  EXPECT_THROW(decoder->decode(bytes), BagDamage);
}

TEST(ScanMessage, IsFoundWithinAMessageOfAnotherType) {
  const auto decoder = ScanDecoder::of(
      connection("my/Slice",
                 std::string("sensor_msgs/LaserScan scan\nfloat64 tilt\n===\nMSG: sensor_msgs/LaserScan\n") +
                     test::kLaserScanDefinition,
                 RosEncoding::ros1));
  ASSERT_TRUE(decoder);
  test::RosBytes bytes(false);
  test::put_scan(bytes, {.stamp_ns = kStamp, .ranges = {1, 2}});
  bytes.put(45.0);
  EXPECT_THAT(decoder->decode(bytes.bytes()).echoes.at(0).ranges, ElementsAre(1, 2));
  EXPECT_FALSE(ScanDecoder::of(connection("std_msgs/Int32", "int32 data\n", RosEncoding::ros1)));
}

class AngleMessages : public testing::Test {
 protected:
  std::optional<AngleMessage> joint_of(const std::string& joint, const std::vector<std::string>& names,
                                       const std::vector<double>& positions) {
    plate_.joint = joint;
    const auto decoder = AngleDecoder::of(
        connection("sensor_msgs/JointState", test::kJointStateDefinition, RosEncoding::ros1), plate_);
    return decoder->decode(test::joints_bytes(kStamp, names, positions, false));
  }
  double number_of(const std::string& type, const test::RosBytes& bytes) {
    return AngleDecoder::of(connection(type, "", RosEncoding::cdr), plate_)->decode(bytes.bytes())->angle;
  }
  RigPlate plate_{.counts_per_revolution = 3600};
};

TEST_F(AngleMessages, OfAJointAreFoundByItsName) {
  const auto reading = joint_of("tilt", {"arm", "tilt", "head"}, {1, 2, 3});
  ASSERT_TRUE(reading);
  EXPECT_EQ(reading->stamp_ns, kStamp);
  EXPECT_EQ(reading->angle, 2);
  EXPECT_FALSE(joint_of("tilt", {"arm"}, {1}));
  EXPECT_FALSE(joint_of("tilt", {"arm", "tilt"}, {1})) << "it has no position";
  EXPECT_EQ(joint_of("", {"only"}, {5})->angle, 5);
  EXPECT_THROW(joint_of("", {"one", "two"}, {5, 6}), BagDamage);
  EXPECT_THROW(joint_of("tilt", {"tilt"}, {std::numeric_limits<double>::quiet_NaN()}), BagDamage);
}

TEST_F(AngleMessages, OfWholeNumbersAreCountsAndOthersRadians) {
  constexpr double kTurn = 2 * std::numbers::pi;
  EXPECT_NEAR(number_of("std_msgs/Int32", test::RosBytes(true).put(std::int32_t{-900})), -kTurn / 4, 1e-12);
  EXPECT_NEAR(number_of("std_msgs/UInt64", test::RosBytes(true).put(std::uint64_t{3600})), kTurn, 1e-12);
  EXPECT_EQ(number_of("std_msgs/Float64", test::RosBytes(true).put(1.25)), 1.25);
  plate_.unit = AngleUnit::deg;
  EXPECT_NEAR(number_of("std_msgs/Float32", test::RosBytes(true).put(90.0F)), kTurn / 4, 1e-12);
}

TEST_F(AngleMessages, OfAFieldThatIsNotThereAreAnError) {
  plate_.topic = "/topic";
  plate_.field = "angle";
  EXPECT_THROW(AngleDecoder::of(connection("std_msgs/Int32", "", RosEncoding::cdr), plate_), Error);
}

}  // namespace
}  // namespace crisp
