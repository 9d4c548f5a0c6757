// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>

#include <crisp/error.hpp>

#include "tests/pipeline/model/support.hpp"

namespace crisp {
namespace {

using namespace crisp::data;

// Ranges and mirror angles are stored as floats: 1e-6 is some of their steps at a few metres.

Eigen::Vector3d point(const Calibration& calibration, const Measurements& beam,
                      const PlateTrajectory& plate) {
  const auto placed = SensorModel(calibration).place(beam, plate);
  EXPECT_EQ(placed.index.size(), 1U);
  return placed.points.col(0);
}

TEST(EquationTwo, ABeamAtThetaZeroPointsDownTheSpinAxis) {
  // Ry(π/2) takes the scan plane's x to −z; the laser sits τ out.
  const auto x = point(one_laser(0, 0.2, 0), one_beam(3, 0), turning_plate(0));
  EXPECT_NEAR((x - Eigen::Vector3d(0.2, 0, -3)).norm(), 0, kFloat);
}

TEST(EquationTwo, ABeamAtThetaNinetyLeavesTangentially) {
  // r = 2 m, θ = 90°, φ = 30°, τ = 0.2 m: 0.2 m out along 30°, then 2 m along 120°.
  const auto x = point(one_laser(0, 0.2, 0), one_beam(2, 90 * kDegree), turning_plate(30 * kDegree));
  EXPECT_NEAR(x.x(), 0.2 * std::cos(30 * kDegree) - 2 * std::sin(30 * kDegree), kFloat);
  EXPECT_NEAR(x.y(), 0.2 * std::sin(30 * kDegree) + 2 * std::cos(30 * kDegree), kFloat);
  EXPECT_NEAR(x.z(), 0, kFloat);
}

TEST(EquationTwo, AlphaTurnsTheScanPlaneAboutThePlatesNormal) {
  // α = 90° turns the tangential beam inwards: from (τ, 0, 0) along −x.
  const auto x = point(one_laser(0, 0.2, 90 * kDegree), one_beam(1, 90 * kDegree), turning_plate(0));
  EXPECT_NEAR((x - Eigen::Vector3d(0.2 - 1, 0, 0)).norm(), 0, kFloat);
}

TEST(EquationTwo, LambdaAddsToThePlatesAngle) {
  // λ = 120° and φ = −30° are 90°: out along +y, the beam at θ = −90° along +x.
  const auto x =
      point(one_laser(120 * kDegree, 0.25, 0), one_beam(4, -90 * kDegree), turning_plate(-30 * kDegree));
  EXPECT_NEAR((x - Eigen::Vector3d(4, 0.25, 0)).norm(), 0, kFloat);
}

TEST(EquationTwo, AHandWorkedPointWithEverythingTurned) {
  // r = 5, θ = 135°, τ = 0.2, α = 10°, λ + φ = 45°:
  // scan plane (−3.535534, 3.535534, 0) → Ry: (0, 3.535534, 3.535534) → Rz(10°):
  // (−0.613939, 3.481821, 3.535534) → +τ: (−0.413939, 3.481821, 3.535534) → Rz(45°):
  // (−2.754718, 2.169320, 3.535534).
  const auto x = point(one_laser(20 * kDegree, 0.2, 10 * kDegree), one_beam(5, 135 * kDegree),
                       turning_plate(25 * kDegree));
  EXPECT_NEAR((x - Eigen::Vector3d(-2.754718, 2.169320, 3.535534)).norm(), 0, 2e-6);
}

TEST(EquationThree, EtaReadsThePlateLater) {
  // At 2 rad/s a lag of +50 ms is 0.1 rad further.
  const auto late = point(one_laser(0, 0.2, 0, 0.05), one_beam(2, 90 * kDegree), turning_plate(0.3, 2));
  const auto turned = point(one_laser(0, 0.2, 0), one_beam(2, 90 * kDegree), turning_plate(0.4));
  EXPECT_NEAR((late - turned).norm(), 0, 1e-9);
}

TEST(SensorModel, LeavesOutWhatThePlatesReadingsDoNotCover) {
  Measurements beams = one_beam(2, 0);
  beams.append(one_beam(3, 0));
  beams.time = {5.0, 1.0};
  const auto placed = SensorModel(one_laser(0, 0.2, 0)).place(beams, turning_plate(0));
  ASSERT_EQ(placed.index, std::vector<std::uint32_t>{1});
  ASSERT_EQ(placed.points.cols(), 1);
  EXPECT_NEAR(placed.points(2, 0), -3, kFloat);
}

TEST(SensorModel, RefusesALaserThatItDoesNotHaveAndAnotherEpoch) {
  Measurements beams = one_beam(2, 0);
  beams.laser = {1};
  EXPECT_THROW(SensorModel(one_laser(0, 0.2, 0)).place(beams, turning_plate(0)), Error);
  beams = one_beam(2, 0);
  beams.epoch_ns = 7;
  EXPECT_THROW(SensorModel(one_laser(0, 0.2, 0)).place(beams, turning_plate(0)), Error);
}

}  // namespace
}  // namespace crisp
