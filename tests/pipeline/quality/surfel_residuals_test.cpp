// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/quality/surfel_residuals.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <numeric>
#include <random>

#include "tests/pipeline/quality/room.hpp"

namespace crisp {
namespace {

using namespace crisp::quality;

/// Beams along a wall x = 1 that is 6 m wide and begins 10 m ahead: they meet it at 4 to 6 degrees. The
/// scanner is then turned by `turn` [rad] about the vertical, and the wall with it.
test::RoomScan graze(double noise, double turn) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> along(10, 16);
  std::uniform_real_distribution<double> height(-1, 1);
  std::normal_distribution<double> error(0, noise);
  const Eigen::AngleAxisd turned(turn, Eigen::Vector3d::UnitZ());
  test::RoomScan scan;
  for (int i = 0; i < 400; ++i) {
    const Eigen::Vector3d end(1, along(random), height(random));
    const Eigen::Vector3d direction = end.normalized();
    const Eigen::Vector3d measured = turned * Eigen::Vector3d(end + error(random) * direction);
    const Eigen::Vector3d aim = turned * direction;
    test::add(scan.points, measured.x(), measured.y(), measured.z());
    test::add(scan.directions, aim.x(), aim.y(), aim.z());
  }
  return scan;
}

/// The wall as a surfel, where it is without a turn.
Surfels wall() {
  std::vector<std::uint32_t> all(400);
  std::iota(all.begin(), all.end(), 0U);
  Surfels surfels;
  surfels.add({.middle = {1, 13, 0},
               .normal = -Eigen::Vector3d::UnitX(),
               .u = Eigen::Vector3d::UnitY(),
               .v = -Eigen::Vector3d::UnitZ(),
               .radius = 1.8},
              all);
  return surfels;
}

/// RMS of the residuals in units of their spread.
double misfit(const Surfels& surfels, const test::RoomScan& scan, const SurfelSettings& settings) {
  double sum = 0;
  for (const SurfelResidual& r : residuals_of(surfels.surfels[0], surfels, scan.beams(), settings)) {
    sum += std::pow(r.distance / r.spread, 2);
  }
  return std::sqrt(sum / 400);
}

TEST(SurfelResiduals, AreTheNoiseOfARefittedPlaneThoughGrazedWallsHaveTurned) {
  const SurfelSettings settings{.noise = 0.008, .floor = 1e-5};
  const double expected = std::sqrt((400 - 3) / 400.0);
  for (const double turn : {0.0, 0.004, -0.004, 0.02, -0.02}) {
    const auto scan = graze(settings.noise, turn);
    Surfels surfels = wall();
    refit_all(surfels, scan.beams(), settings);
    EXPECT_NEAR(misfit(surfels, scan, settings), expected, 0.12) << turn;
    const Eigen::Vector3d normal(-std::cos(turn), -std::sin(turn), 0);
    EXPECT_NEAR((surfels.surfels[0].normal - normal).norm(), 0, 3e-4) << turn;  // 5 standard errors
  }
  EXPECT_GT(misfit(wall(), graze(settings.noise, 0.02), settings), 2);  // against a plane that has not
}

TEST(SurfelResiduals, KeepTheirWeightsWhenPlanesAreRefitted) {
  const SurfelSettings settings{.noise = 0.008, .floor = 1e-5};
  auto scan = graze(settings.noise, 0.004);
  Surfels surfels = wall();
  surfels.weights[7] = 0;
  surfels.weights[8] = 0.5;
  scan.points.x[7] += 0.5;  // would turn the plane if it counted
  const auto weights = surfels.weights;
  refit_all(surfels, scan.beams(), settings);
  EXPECT_EQ(surfels.weights, weights);
  EXPECT_NEAR(surfels.surfels[0].normal.y(), -std::sin(0.004), 1e-4);
}

}  // namespace
}  // namespace crisp
