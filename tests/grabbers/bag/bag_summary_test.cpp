// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/bag/bag_summary.hpp"

#include <gmock/gmock.h>

#include "grabbers/bag/bag_file.hpp"
#include "tests/grabbers/bag/bag_writer.hpp"
#include "tests/support/temporary_folder.hpp"

namespace crisp {
namespace {

using namespace crisp::bag;

TEST(BagSummary, ReportsTopicsTypesRatesGapsAndClocks) {
  constexpr std::int64_t kBegin = 1'700'000'000'000'000'000;
  test::TestBag bag{.topics = {{"/scan", "sensor_msgs/LaserScan", test::kLaserScanDefinition},
                               {"/joints", "sensor_msgs/JointState", test::kJointStateDefinition},
                               {"/imu", "sensor_msgs/Imu", ""}}};
  for (const std::int64_t ms : {0, 100, 200, 500}) {
    const std::int64_t stamp = kBegin + 1'000'000 * ms;
    bag.messages.push_back(
        {0, stamp + 5'000'000 + 10'000 * ms, test::scan_bytes({.stamp_ns = stamp}, false)});
  }
  bag.messages.push_back({1, kBegin, test::joints_bytes(kBegin + 2'000'000, {"tilt", "pan"}, {0, 0}, false)});
  bag.messages.push_back({1, kBegin, "x"});
  const test::TemporaryFolder folder;
  test::write_rosbag1(folder / "a.bag", bag, "lz4");
  BagFile file(folder / "a.bag");
  const auto summary = summarize(file.reader());
  ASSERT_EQ(summary.topics.size(), 3U);
  EXPECT_EQ(summary.format, "rosbag 1");
  EXPECT_EQ(summary.topics[0].topic, "/scan");
  EXPECT_EQ(summary.topics[0].messages, 4U);
  EXPECT_NEAR(summary.topics[0].rate(), 3 / 0.505, 1e-6);
  EXPECT_EQ(summary.topics[0].longest_gap_ns, 303'000'000);
  EXPECT_NEAR(summary.topics[0].least_delay, 0.005, 1e-9);
  EXPECT_NEAR(summary.topics[0].most_delay, 0.010, 1e-9);
  EXPECT_THAT(summary.topics[1].joints, testing::ElementsAre("pan", "tilt"));
  EXPECT_NEAR(summary.topics[1].least_delay, -0.002, 1e-9);
  EXPECT_EQ(summary.topics[1].unreadable, 1U);
  EXPECT_EQ(summary.topics[2].messages, 0U);
  EXPECT_THAT(to_text(summary), testing::HasSubstr("5.0 to 10.0 ms"));
  EXPECT_EQ(to_json(summary)["topics"][2]["type"], "sensor_msgs/Imu");
}

}  // namespace
}  // namespace crisp
