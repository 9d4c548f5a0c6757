// SPDX-License-Identifier: BSD-3-Clause
// Real recordings of actuated lasers: their bags, and bags made of their tables, give what the tables give.
#include <gmock/gmock.h>

#include <algorithm>
#include <fstream>
#include <numbers>
#include <sstream>

#include "grabbers/bag/bag_stage.hpp"
#include "grabbers/table/table_stage.hpp"
#include "tests/grabbers/bag/bag_writer.hpp"
#include "tests/support/shared_data.hpp"
#include "tests/support/stage_driver.hpp"
#include "tests/support/temporary_folder.hpp"

namespace crisp {
namespace {

using namespace crisp::bag;
using namespace crisp::table;
namespace fs = std::filesystem;
using test::StageDriver;

constexpr float kStep = 0.006135923322F;   // [rad]
constexpr float kInterval = 9.76563e-05F;  // [s]
constexpr float kFirst = -1.570796371F;    // [rad] of Jeremy.bag
constexpr double kDegree = std::numbers::pi / 180;

fs::path urg(const char* name) { return shared_data() / "actuated/urg04lx_tilt_stand" / name; }

Rig tilting_rig() {
  Rig rig;
  rig.lasers = {{.name = "urg", .mount = -90 * kDegree}};
  rig.plate.counts_per_revolution = 4800;
  return rig;
}

StageDriver run_table(const fs::path& table) {
  auto stage = StageDriver::of<TableStage>({{"file", OptionScalar(table.string())},
                                            {"time_column", OptionScalar(std::int64_t{3})},
                                            {"time_unit", OptionScalar(std::string("ns"))},
                                            {"receipt_column", OptionScalar(std::int64_t{2})},
                                            {"receipt_unit", OptionScalar(std::string("ns"))},
                                            {"period", OptionScalar(0.1)},
                                            {"angle_column", OptionScalar(std::int64_t{4})},
                                            {"angle_unit", OptionScalar(std::string("deg"))},
                                            {"range_column", OptionScalar(std::int64_t{5})},
                                            {"range_unit", OptionScalar(std::string("mm"))},
                                            {"start_angle", OptionScalar(static_cast<double>(kFirst))},
                                            {"angle_step", OptionScalar(static_cast<double>(kStep))},
                                            {"beam_interval", OptionScalar(static_cast<double>(kInterval))}});
  stage.run().rig = tilting_rig();
  stage.feed();
  return stage;
}

StageDriver run_bag(const fs::path& bag, const Rig& rig) {
  auto stage = StageDriver::of<BagStage>({{"file", OptionScalar(bag.string())}});
  stage.run().rig = rig;
  stage.feed();
  return stage;
}

/// The first rows of a table as scans and joint states.
test::TestBag bag_of(const fs::path& table, bool ros2) {
  const std::string msg = ros2 ? "/msg/" : "/";
  test::TestBag bag{
      .topics = {
          {"/tilt_scan", "sensor_msgs" + msg + "LaserScan", ros2 ? "" : test::kLaserScanDefinition},
          {"/joint_states", "sensor_msgs" + msg + "JointState", ros2 ? "" : test::kJointStateDefinition}}};
  std::ifstream rows(table);
  std::string row;
  while (std::getline(rows, row)) {
    if (row.starts_with('#')) continue;
    std::istringstream numbers(row);
    char comma = 0;
    std::int64_t k = 0, receipt = 0, stamp = 0;
    double tilt = 0;
    int range = 0;
    numbers >> k >> comma >> receipt >> comma >> stamp >> comma >> tilt;
    std::vector<float> ranges;
    while (numbers >> comma >> range) ranges.push_back(static_cast<float>(range * 0.001));
    bag.messages.push_back(
        {1, receipt, test::joints_bytes(stamp, {"wheel", "tilt_joint"}, {0, tilt * kDegree}, ros2)});
    bag.messages.push_back({0, receipt,
                            test::scan_bytes({.stamp_ns = stamp,
                                              .angle_min = kFirst,
                                              .angle_increment = kStep,
                                              .time_increment = kInterval,
                                              .scan_time = 0.1F,
                                              .ranges = ranges},
                                             ros2)});
  }
  return bag;
}

void expect_same(StageDriver& bag, StageDriver& table, double tolerance) {
  const auto actual = bag.given<Measurements>();
  const auto expected = table.given<Measurements>();
  ASSERT_EQ(actual.size(), expected.size());
  ASSERT_GT(actual.size(), 100U);
  for (std::size_t i = 0; i < actual.size(); ++i) {
    ASSERT_EQ(actual[i]->beam, expected[i]->beam) << "scan " << i;
    ASSERT_EQ(actual[i]->epoch_ns, expected[i]->epoch_ns);
    for (std::size_t k = 0; k < actual[i]->size(); ++k) {
      ASSERT_NEAR(actual[i]->range[k], expected[i]->range[k], tolerance);
      ASSERT_NEAR(actual[i]->mirror_angle[k], expected[i]->mirror_angle[k], tolerance);
      ASSERT_NEAR(actual[i]->time[k], expected[i]->time[k], tolerance);
    }
  }
  const auto plate = bag.given<PlateTrajectory>().at(0);
  const auto expected_plate = table.given<PlateTrajectory>().at(0);
  ASSERT_TRUE(std::ranges::equal(plate->times(), expected_plate->times()));
  ASSERT_EQ(plate->angles().size(), expected_plate->angles().size());
  for (std::size_t i = 0; i < plate->angles().size(); ++i)
    ASSERT_NEAR(plate->angles()[i], expected_plate->angles()[i], 1e-12);
  const auto readings = bag.given<PlateReading>();
  const auto expected_readings = table.given<PlateReading>();
  ASSERT_EQ(readings.size(), expected_readings.size());
  for (std::size_t i = 0; i < readings.size(); ++i) {
    ASSERT_EQ(readings[i]->count, expected_readings[i]->count);
    ASSERT_EQ(readings[i]->device_us, expected_readings[i]->device_us);
  }
}

TEST(RecordedBags, MadeOfATableGiveWhatTheTableGives) {
  const fs::path table = urg("Jeremy.csv");
  if (!fs::exists(table)) GTEST_SKIP() << "no shared data: Jeremy.csv";
  auto expected = run_table(table);
  Rig rig = tilting_rig();
  rig.lasers[0].topic = "/tilt_scan";
  rig.plate.joint = "tilt_joint";
  const test::TemporaryFolder folder;
  test::write_rosbag1(folder / "a.bag", bag_of(table, false), "bz2");
  test::write_mcap(folder / "a.mcap", bag_of(table, true), "zstd");
  test::write_db3(folder / "a.db3", bag_of(table, true));
  for (const auto* name : {"a.bag", "a.mcap", "a.db3"}) {
    auto bag = run_bag(folder / name, rig);
    expect_same(bag, expected, 0);
  }
}

TEST(RecordedBags, OfARealTiltingLaserGiveWhatTheirTableGives) {
  const fs::path bag_file = urg("Jeremy.bag");
  if (!fs::exists(bag_file)) GTEST_SKIP() << "no shared data: Jeremy.bag";
  Rig rig = tilting_rig();
  rig.plate.topic = "/slice";
  rig.plate.field = "stepAngle";
  rig.plate.unit = AngleUnit::deg;
  auto table = run_table(urg("Jeremy.csv"));
  auto bag = run_bag(bag_file, rig);
  expect_same(bag, table, 2e-5);
}

TEST(RecordedBags, OfAStationaryRealLaserGiveItsScans) {
  const fs::path file = shared_data() / "sick/lms1xx-20220923-static.bag";
  if (!fs::exists(file)) GTEST_SKIP() << "no shared data: lms1xx-20220923-static.bag";
  Rig rig = tilting_rig();
  rig.lasers[0].topic = "/sick_lms_1xx/scan";
  auto bag = run_bag(file, rig);
  const auto scans = bag.given<Scan>();
  ASSERT_EQ(scans.size(), 89U);
  for (const auto& scan : scans) ASSERT_EQ(scan->echoes.at(0).ranges.size(), 541U);
}

}  // namespace
}  // namespace crisp
