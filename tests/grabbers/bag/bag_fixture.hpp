// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gtest/gtest.h>

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "grabbers/bag/bag_stage.hpp"
#include "tests/grabbers/bag/bag_writer.hpp"
#include "tests/support/stage_driver.hpp"
#include "tests/support/temporary_folder.hpp"

namespace crisp::test {

inline constexpr std::int64_t kBegin = 1'700'000'000'000'000'000;
inline constexpr std::int64_t kMs = 1'000'000;

/// A bag of ROS 1 with scans, joint states and counts, and a rig of one laser: runs grabber.bag on it.
class BagFixture : public testing::Test {
 protected:
  BagFixture() {
    rig_.lasers.resize(1);
    rig_.lasers[0] = {.name = "front", .mount = 0.5};
    rig_.plate.counts_per_revolution = 1'000'000;
    bag_.topics = {{"/scan", "sensor_msgs/LaserScan", kLaserScanDefinition},
                   {"/joints", "sensor_msgs/JointState", kJointStateDefinition},
                   {"/count", "std_msgs/Int32", "int32 data\n"}};
  }

  void add_scan(std::int64_t ms, std::vector<float> ranges, std::size_t topic = 0) {
    const std::int64_t stamp = kBegin + kMs * ms;
    bag_.messages.push_back({topic, stamp + 30 * kMs,
                             scan_bytes({.stamp_ns = stamp,
                                         .angle_min = 1,
                                         .angle_increment = -0.25F,
                                         .time_increment = 0.0009765625F,
                                         .scan_time = 0.025F,
                                         .ranges = std::move(ranges)},
                                        false)});
  }
  void add_joint(std::int64_t ms, double angle) {
    const std::int64_t stamp = kBegin + kMs * ms;
    bag_.messages.push_back({1, stamp + kMs, joints_bytes(stamp, {"x", "tilt"}, {9, angle}, false)});
  }

  StageDriver run(std::map<std::string, OptionValue> options = {}) {
    write_rosbag1(folder_ / "a.bag", bag_, "none");
    options.emplace("file", OptionScalar((folder_ / "a.bag").string()));
    auto stage = StageDriver::of<bag::BagStage>(options);
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

  TemporaryFolder folder_;
  TestBag bag_;
  Rig rig_;
};

}  // namespace crisp::test
