// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/bag/ros_message_schema.hpp"

#include <gmock/gmock.h>

#include "grabbers/bag/byte_cursor.hpp"
#include "tests/grabbers/bag/bag_writer.hpp"

namespace crisp {
namespace {

using namespace crisp::bag;
using testing::ElementsAre;

const std::string kDefinition =
    "# of everything\n"
    "int32 LIMIT=5\nstring NAME = a # b\n"
    "uint8[3] three\n"
    "Inner[] inner # several\n"
    "string<=10 name\n"
    "float64[<=4] few\n"
    "int64 last 7\n"
    "===\nMSG: my_msgs/msg/Inner\nbool flag\nfloat32[] values\r\n";

std::vector<std::string> paths(const RosMessageSchema& layout) {
  std::vector<std::string> all;
  for (const auto& field : layout.fields) all.push_back(field.path);
  return all;
}

TEST(RosMessageSchema, HasTheFieldsOfTheDefinitionWithoutItsConstants) {
  const auto layout = parse_ros_layout("my_msgs/All", kDefinition);
  ASSERT_TRUE(layout);
  EXPECT_THAT(paths(*layout),
              ElementsAre("", "three", "inner", "inner.flag", "inner.values", "name", "few", "last"));
  EXPECT_EQ(layout->find("inner.values"), 4U);
  EXPECT_EQ(layout->find_type("my_msgs/Inner"), 2U);
}

TEST(RosMessageSchema, HasTheFirstStampThatIsThereOnce) {
  const std::string header = "===\nMSG: std_msgs/Header\nuint32 seq\ntime stamp\nstring frame_id\n";
  const auto path = [&](const std::string& fields) -> std::string {
    const auto layout = parse_ros_layout("a/A", fields + header + "===\nMSG: a/B\nHeader header\n");
    return layout && layout->stamp() ? layout->stamp()->path : "none";
  };
  EXPECT_EQ(path("Header header\nB b\n"), "header.stamp");
  EXPECT_EQ(path("float64 x\nB b\n"), "b.header.stamp");
  EXPECT_EQ(path("B[] several\n"), "none");
  EXPECT_EQ(path("duration stamp\n"), "none");
}

TEST(RosMessageSchema, IsNothingWhereATypeIsMissingOrHoldsItself) {
  EXPECT_FALSE(parse_ros_layout("a/A", "B b\n"));
  EXPECT_FALSE(parse_ros_layout("a/A", "A a\n"));
  EXPECT_FALSE(parse_ros_layout("a/A", "int32\n"));
  EXPECT_FALSE(parse_ros_layout("a/A", "int32[x] a\n"));
  EXPECT_FALSE(parse_ros_layout("a/Unknown", ""));
}

class DecodeRos : public testing::TestWithParam<bool> {
 protected:
  RosEncoding encoding() const { return GetParam() ? RosEncoding::cdr : RosEncoding::ros1; }
  std::string message() const {
    test::RosBytes bytes(GetParam());
    for (const std::uint8_t value : {1, 2, 3}) bytes.put(value);
    bytes.put(std::uint32_t{2});
    bytes.put(std::uint8_t{1}).list<float>({0.5F, 1.5F});
    bytes.put(std::uint8_t{0}).list<float>({});
    bytes.text("abc").list<double>({2.5}).put(std::int64_t{-7'000'000'000});
    return bytes.bytes();
  }
};
INSTANTIATE_TEST_SUITE_P(InBothEncodings, DecodeRos, testing::Bool());

TEST_P(DecodeRos, FindsEveryValue) {
  const auto layout = *parse_ros_layout("my_msgs/All", kDefinition);
  const std::string bytes = message();
  const auto values = decode_ros(layout, encoding(), bytes);
  ASSERT_EQ(values.size(), 8U);
  EXPECT_EQ(values[0].count, 3U);
  EXPECT_EQ(values[0].number(RosType::uint8, 2), 3);
  EXPECT_EQ(values[2].number(RosType::float32, 1), 1.5);
  EXPECT_EQ(values[4].count, 0U);
  EXPECT_EQ(values[5].bytes, "abc");
  EXPECT_EQ(values[6].number(RosType::float64), 2.5);
  EXPECT_EQ(values[7].integer(RosType::int64), -7'000'000'000);
}

TEST_P(DecodeRos, RefusesAMessageThatEndsBeforeItsContent) {
  const auto layout = *parse_ros_layout("my_msgs/All", kDefinition);
  const std::string bytes = message();
  for (std::size_t size = 0; size < bytes.size(); ++size)
    EXPECT_THROW(decode_ros(layout, encoding(), std::string_view(bytes).substr(0, size)), BagDamage) << size;
}

}  // namespace
}  // namespace crisp
