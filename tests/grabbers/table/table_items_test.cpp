// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/table/table_items.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include <crisp/deskew.hpp>
#include <crisp/error.hpp>

#include "pipeline/data/degree.hpp"

namespace crisp {
namespace {

using namespace crisp::data;
using namespace crisp::table;
using testing::DoubleNear;
using testing::ElementsAre;
using testing::Pair;

constexpr std::int64_t kMs = 1'000'000;  // [ns]

/// A laser whose scan plane holds the actuator's axis; its beam at 90° points away from the axis.
Rig tilting(double forward, double sideways) {
  const double azimuth = std::atan2(sideways, forward);
  Rig rig;
  RigLaser laser{.name = "laser"};
  laser.nominal.lambda.value = azimuth;
  laser.nominal.tau.value = std::hypot(forward, sideways);
  laser.nominal.alpha.value = -90 * kDegree - azimuth;
  rig.lasers = {laser};
  rig.plate.counts_per_revolution = 3600;
  return rig;
}

Eigen::Vector3d point_of(const Rig& rig, double tilt, double mirror, float range) {
  TableItems items({.angle_column = 1, .range_column = 2}, {.start_angle = mirror, .angle_step = 0.1}, rig);
  for (const std::int64_t t : {0, 10}) items.add({.time_ns = t * kMs, .angle = tilt, .ranges = {range}});
  const auto beams = items.take_measurements();
  MirrorAngleCache mirrors;
  const auto cloud =
      deskew(*beams.at(0), items.trajectory(), SensorModel(nominal_calibration(rig)), mirrors).cloud;
  const auto& p = cloud->points.at(0);
  return {static_cast<double>(p.x), static_cast<double>(p.y), static_cast<double>(p.z)};
}

MATCHER_P3(IsPoint, x, y, z, "") { return (arg - Eigen::Vector3d(x, y, z)).norm() < 1e-6; }

TEST(TiltingUnit, ItsMiddleBeamPointsAwayFromTheAxis) {
  EXPECT_THAT(point_of(tilting(0, 0), 30 * kDegree, 90 * kDegree, 2), IsPoint(std::sqrt(3.0), 1.0, 0.0));
}

TEST(TiltingUnit, ItsFanSpreadsAlongTheAxis) {
  // 2 m at 30° of the fan: 1 m away from the axis, and √3 m down along it, wherever it is tilted.
  EXPECT_THAT(point_of(tilting(0, 0), 90 * kDegree, 30 * kDegree, 2), IsPoint(0.0, 1.0, -std::sqrt(3.0)));
}

TEST(TiltingUnit, ItsOpticalCentreMayLieBeforeTheAxisAndNextToIt) {
  // 0.3 m along the middle beam and 0.4 m along the fan's normal, which at 0° of tilt are x and y.
  EXPECT_THAT(point_of(tilting(0.3, 0.4), 0, 90 * kDegree, 2), IsPoint(2.3, 0.4, 0.0));
  EXPECT_THAT(point_of(tilting(0.3, 0.4), 90 * kDegree, 90 * kDegree, 2), IsPoint(-0.4, 2.3, 0.0));
}

TEST(FixedBeam, IsALaserWhoseMirrorAngleNeverChanges) {
  // A turning head: elevation e is θ = 90° + e. At φ = 60° and e = 30°, 2 m away.
  const TableFormat format{.angle_column = 1, .range_column = 3, .mirror_column = 2};
  TableItems items(format, {}, tilting(0, 0));
  for (const std::int64_t t : {0, 1}) {
    const auto item =
        items.add({.time_ns = t * kMs, .angle = 60 * kDegree, .mirror = 120 * kDegree, .ranges = {2.0F}});
    ASSERT_TRUE(item);
    EXPECT_EQ(item->scan, nullptr) << "single beams are no scans";
  }
  const auto beams = items.take_measurements();
  ASSERT_EQ(beams.size(), 1U);
  MirrorAngleCache mirrors;
  const auto cloud =
      deskew(*beams[0], items.trajectory(), SensorModel(nominal_calibration(tilting(0, 0))), mirrors).cloud;
  EXPECT_NEAR(cloud->points.at(0).x, std::sqrt(3.0) / 2, 1e-6);
  EXPECT_NEAR(cloud->points.at(0).y, 1.5, 1e-6);
  EXPECT_NEAR(cloud->points.at(0).z, 1.0, 1e-6);
}

TEST(TableItems, AMovingActuatorHasEachRowsAngleAtItsTime) {
  TableItems items({.angle_column = 1, .range_column = 2}, {.angle_step = 0.1, .beam_interval = 1e-3},
                   tilting(0, 0));
  items.add({.time_ns = 5000 * kMs, .angle = 0, .ranges = {1, 1, 0, 1}});
  items.add({.time_ns = 5010 * kMs, .angle = 0.1, .ranges = {1}});
  const auto beams = items.take_measurements();
  ASSERT_EQ(beams.size(), 2U);
  EXPECT_EQ(beams[0]->epoch_ns, 5000 * kMs);
  EXPECT_THAT(beams[0]->time, ElementsAre(0, DoubleNear(0.001, 1e-12), DoubleNear(0.003, 1e-12)));
  EXPECT_THAT(beams[0]->beam, ElementsAre(0, 1, 3));
  const auto plate = items.trajectory();
  EXPECT_THAT(plate.times(), ElementsAre(0.0, DoubleNear(0.01, 1e-12)));
  const double step = 0.1 * kDegree;  // 3600 a turn
  EXPECT_THAT(plate.angles(), ElementsAre(0.0, DoubleNear(57 * step, 1e-12)));
}

TEST(TableItems, ASteppingActuatorStandsFromTheFirstBeamToTheLast) {
  TableItems items({.angle_column = 1, .range_column = 2},
                   {.angle_step = 0.1, .beam_interval = 1e-3, .actuator = ActuatorMotion::stands},
                   tilting(0, 0));
  items.add({.time_ns = 0, .angle = 1 * kDegree, .ranges = {1, 1, 1, 1}});
  items.add({.time_ns = 10 * kMs, .angle = 2 * kDegree, .ranges = {1, 1, 1, 1}});
  const auto plate = items.trajectory();
  EXPECT_THAT(plate.times(),
              ElementsAre(0, DoubleNear(0.004, 1e-12), DoubleNear(0.01, 1e-12), DoubleNear(0.014, 1e-12)));
  EXPECT_DOUBLE_EQ(plate.angles()[1], plate.angles()[0]);
  EXPECT_DOUBLE_EQ(plate.angles()[3], plate.angles()[2]);
}

TEST(TableItems, TheDevicesCountTimesItsScansAcrossItsWrap) {
  const TableFormat format{.counter_column = 1, .counter_modulus = 256, .period = 0.01, .angle_column = 2};
  TableItems items(format, {.angle_step = 0.1}, tilting(0, 0));
  std::vector<std::uint32_t> stamps;
  for (const std::int64_t counter : {254, 255, 255, 0, 3}) {
    const auto item = items.add({.receipt_ns = 0, .counter = counter, .ranges = {1}});
    if (item) stamps.push_back(item->scan->scan_time_us);
  }
  EXPECT_THAT(stamps, ElementsAre(0, 10'000, 20'000, 50'000));
  EXPECT_THAT(items.losses(), ElementsAre(Pair("rows with the counter of the row before", 1)));
}

TEST(TableItems, ARowThatIsLeftOutDoesNotMoveTheCount) {
  TableItems items({.counter_column = 1, .counter_modulus = 65536, .period = 0.01, .angle_column = 2},
                   {.angle_step = 0.1}, tilting(0, 0));
  std::vector<std::uint32_t> stamps;
  for (const std::int64_t counter : {10, 9, 11}) {
    const auto item = items.add({.time_ns = counter * 10 * kMs, .counter = counter, .ranges = {1}});
    if (item) stamps.push_back(item->scan->scan_time_us);
  }
  EXPECT_THAT(stamps, ElementsAre(0, 10'000));
  EXPECT_THAT(items.losses(), ElementsAre(Pair("rows that are earlier than the row before", 1)));
}

TEST(TableItems, ReportRowsWithoutCountOrTime) {
  const TableRow row{.time_ns = 1'000'000'000, .receipt_ns = 1'010'000'000, .ranges = {1}};
  TableRow counted = row;
  counted.counter = 7;
  TableRow received = row;
  received.time_ns.reset();
  const auto taken = [](const TableRow& one) {
    return *TableItems({.period = 0.01, .angle_column = 2}, {.angle_step = 0.1}, tilting(0, 0)).add(one);
  };
  EXPECT_FALSE(taken(row).reading->numbered) << "a table holds no count of an encoder's readings";
  EXPECT_FALSE(taken(row).scan->numbered);
  EXPECT_TRUE(taken(row).scan->timed);
  EXPECT_TRUE(taken(counted).scan->numbered);
  EXPECT_FALSE(taken(counted).scan->timed) << "by its count times the period";
  EXPECT_FALSE(taken(received).scan->timed);
}

TEST(TableItems, AnglesGoOnAcrossAWholeTurn) {
  TableItems items({.angle_column = 1, .range_column = 2}, {.angle_step = 0.1}, tilting(0, 0));
  std::int64_t t = 0;
  for (const double degrees : {350.0, 10.0, 30.0, 10.0}) {
    items.add({.time_ns = t += kMs, .angle = degrees * kDegree, .ranges = {1}});
  }
  EXPECT_THAT(items.trajectory().angles(),
              ElementsAre(DoubleNear(350 * kDegree, 1e-9), DoubleNear(370 * kDegree, 1e-9),
                          DoubleNear(390 * kDegree, 1e-9), DoubleNear(370 * kDegree, 1e-9)));
}

TEST(TableItems, CountsWhatIsOutOfOrderOrOfNobody) {
  TableItems items({.angle_column = 1, .range_column = 2}, {.angle_step = 0.1}, tilting(0, 0));
  items.add({.time_ns = 10 * kMs, .ranges = {1}});
  EXPECT_FALSE(items.add({.time_ns = 9 * kMs, .ranges = {1}}));
  EXPECT_FALSE(items.add({.time_ns = 11 * kMs, .laser = 1, .ranges = {1}}));
  EXPECT_THAT(items.losses(), ElementsAre(Pair("rows of a laser that the rig does not have", 1),
                                          Pair("rows that are earlier than the row before", 1)));
  EXPECT_THROW(items.trajectory(), Error);
}

}  // namespace
}  // namespace crisp
