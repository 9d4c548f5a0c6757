// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include <crisp/deskew.hpp>
#include <crisp/rig.hpp>

namespace crisp {
namespace {

constexpr double kHalfTurn = std::numbers::pi;

/// A plate that turns once a second from t = 0 to 2 s.
PlateTrajectory once_a_second() {
  std::vector<double> times, angles;
  for (int i = 0; i <= 1000; ++i) {
    times.push_back(i * 0.002);
    angles.push_back(2 * kHalfTurn * times.back());
  }
  return {1'700'000'000'000'000'000, times, angles, 0.01};
}

/// Deskews a scan without predecessors.
Deskewed deskew(const Measurements& beams, const PlateTrajectory& plate, const SensorModel& model) {
  MirrorAngleCache none;
  return deskew(beams, plate, model, none);
}

Measurements two_beams() {
  Measurements beams;
  beams.epoch_ns = 1'700'000'000'000'000'000;
  beams.range = {2.0F, 3.0F};
  beams.mirror_angle = {static_cast<float>(kHalfTurn / 2), 0.0F};
  beams.time = {0.25, 1.5000001};
  beams.laser = {0, 1};
  beams.remission = {200, 100};
  beams.beam = {270, 90};
  return beams;
}

TEST(Deskew, PlacesEachBeamWhereThePlateWasWhenItWasFired) {
  const SensorModel model(nominal_calibration(default_rig()));
  const auto result = deskew(two_beams(), once_a_second(), model);
  ASSERT_EQ(result.cloud->size(), 2U);
  // At a quarter turn, laser 1 (λ = 0) is at (0, 0.2, 0); its beam at θ = 90° leaves along −x.
  EXPECT_NEAR((result.cloud->points[0].getVector3fMap() - Eigen::Vector3f(-2, 0.2F, 0)).norm(), 0, 1e-6);
  // At half a turn, laser 2 (λ = 120°) is at azimuth 300°; its beam at θ = 0 points straight down.
  const Eigen::Vector3f below(0.2F * std::cos(5 * kHalfTurn / 3), 0.2F * std::sin(5 * kHalfTurn / 3), -3);
  EXPECT_NEAR((result.cloud->points[1].getVector3fMap() - below).norm(), 0, 1e-5);
}

TEST(Deskew, KeepsTimeLaserBeamAndRemissionOfEachPoint) {
  const auto result = deskew(two_beams(), once_a_second(), SensorModel(nominal_calibration(default_rig())));
  EXPECT_EQ(result.cloud->header.stamp, 1'700'000'000'000'000U);
  EXPECT_EQ(result.cloud->points[1].time, 1.5000001);
  EXPECT_EQ(result.cloud->points[1].laser, 1);
  EXPECT_EQ(result.cloud->points[1].beam, 90);
  EXPECT_EQ(result.cloud->points[0].intensity, 200);
}

TEST(Deskew, LeavesOutAndCountsBeamsOutsideThePlatesReadings) {
  Measurements beams = two_beams();
  beams.time[0] = -0.001;
  const auto result = deskew(beams, once_a_second(), SensorModel(nominal_calibration(default_rig())));
  EXPECT_EQ(result.outside, 1U);
  ASSERT_EQ(result.cloud->size(), 1U);
  EXPECT_EQ(result.cloud->points[0].laser, 1);
}

}  // namespace
}  // namespace crisp
