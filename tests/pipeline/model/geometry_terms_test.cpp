// SPDX-License-Identifier: BSD-3-Clause
// Points worked out by hand from docs/effects.md for terms of mounts, mirrors, the plate and the base.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/pipeline/model/terms_support.hpp"

namespace crisp {
namespace {

using namespace crisp::data;

constexpr double kMrad = 1e-3;

void expect_point(const Eigen::Vector3d& x, double a, double b, double c) {
  EXPECT_NEAR(x.x(), a, kFloat);
  EXPECT_NEAR(x.y(), b, kFloat);
  EXPECT_NEAR(x.z(), c, kFloat);
}

TEST(MountTerms, TheTangentialOffsetIsAcrossTheLasersRadius) {
  // λ = 90°: the laser is out along y, and its tangent points to −x.
  const auto x = point_with("mount.tangential_offset", {{"y", 0.003}}, one_laser(90 * kDegree, 0.2, 0),
                            one_beam(2, 0), turning_plate(0));
  expect_point(x, -0.003, 0.2, -2);
}

TEST(MountTerms, TheAxialOffsetIsAlongTheAxis) {
  const auto x =
      point_with("mount.axial_offset", {{"z", 0.02}}, one_laser(0, 0.2, 0), one_beam(2, 0), turning_plate(0));
  expect_point(x, 0.2, 0, -1.98);
}

TEST(MountTerms, TheMirrorsZeroTurnsTheBeamWithinItsPlane) {
  // θ = 80° and 10° more are 90°: along the tangent.
  const auto x = point_with("mount.mirror_zero", {{"theta", 10 * kDegree}}, one_laser(0, 0.2, 0),
                            one_beam(3, 80 * kDegree), turning_plate(0));
  expect_point(x, 0.2, 3, 0);
}

TEST(MountTerms, ATiltOfTheScanPlaneLeansTheBeamThatPointsDownOutOfThePlane) {
  // right-handed about y: −z goes to −x. 3-4-5 triangle: tan tilt = 3/4.
  const double tilt = std::atan2(3, 4);
  const auto down = point_with("mount.scan_plane_tilt", {{"tilt", tilt}}, one_laser(0, 0.2, 0),
                               one_beam(5, 0), turning_plate(0));
  expect_point(down, 0.2 - 3, 0, -4);
  const auto along = point_with("mount.scan_plane_tilt", {{"tilt", tilt}}, one_laser(0, 0.2, 0),
                                one_beam(5, 90 * kDegree), turning_plate(0));
  expect_point(along, 0.2, 5, 0);
  const auto radial = point_with("mount.scan_plane_tilt", {{"tilt", tilt}}, one_laser(0, 0.2, -90 * kDegree),
                                 one_beam(5, 0), turning_plate(0));
  expect_point(radial, 0.2, 3, -4);  // out of the radial plane
}

TEST(MirrorTerms, AConeLiftsTheBeamOutOfItsPlaneByTheSameAngleEverywhere) {
  // sin κ = 0.6: of 5 m 3 m go outwards and 4 m stay in the plane.
  const double kappa = std::asin(0.6);
  const auto down =
      point_with("mirror.cone", {{"kappa", kappa}}, one_laser(0, 0.2, 0), one_beam(5, 0), turning_plate(0));
  expect_point(down, 3.2, 0, -4);
  const auto along = point_with("mirror.cone", {{"kappa", kappa}}, one_laser(0, 0.2, 0),
                                one_beam(5, -90 * kDegree), turning_plate(0));
  expect_point(along, 3.2, -4, 0);
}

TEST(MirrorTerms, EccentricityAddsAToTheAngleAtZeroAndBAtNinety) {
  const std::map<std::string, double> both = {{"a", 90 * kDegree}, {"b", -30 * kDegree}};
  const auto down =
      point_with("mirror.eccentricity", both, one_laser(0, 0.2, 0), one_beam(2, 0), turning_plate(0));
  expect_point(down, 0.2, 2, 0);  // as at 90°
  const auto along = point_with("mirror.eccentricity", both, one_laser(0, 0.2, 0), one_beam(2, 90 * kDegree),
                                turning_plate(0));
  expect_point(along, 0.2, std::sqrt(3), -1);  // as at 60°: −z cos 60°
}

TEST(EncoderTerms, HarmonicsAddUpToWhatTheyAreAtTheReading) {
  // φ = 30°: cos 30° = √3/2, sin 30° = 1/2; cos 60° = 1/2, sin 60° = √3/2.
  const auto azimuth = [](const std::string& term, double a, double b) {
    const auto x = point_with(term, {{"a", a}, {"b", b}}, one_laser(0, 1, 0), one_beam(1, 0),
                              turning_plate(30 * kDegree));
    return std::atan2(x.y(), x.x()) - 30 * kDegree;
  };
  EXPECT_NEAR(azimuth("encoder.eccentricity", 4 * kMrad, 2 * kMrad), (2 * std::sqrt(3) + 1) * kMrad, 1e-12);
  EXPECT_NEAR(azimuth("encoder.second_harmonic", 4 * kMrad, 2 * kMrad), (2 + std::sqrt(3)) * kMrad, 1e-12);
}

TEST(EncoderTerms, BacklashChangesItsSignWithTheDirection) {
  const auto azimuth = [](double rate) {
    const auto x = point_with("encoder.backlash", {{"delta", 2 * kMrad}}, one_laser(0, 1, 0), one_beam(1, 0),
                              turning_plate(0.5, rate));
    return std::atan2(x.y(), x.x()) - 0.5;
  };
  EXPECT_NEAR(azimuth(0.15), 2 * kMrad, 1e-9);
  EXPECT_NEAR(azimuth(-1), -2 * kMrad, 1e-9);
  EXPECT_NEAR(azimuth(0), 0, 1e-12);
}

TEST(EncoderTerms, TheSpeedLagGrowsWithTheSquareAndHasTheSignOfTheRate) {
  const auto azimuth = [](double rate) {
    const auto x = point_with("encoder.speed_lag", {{"k", 1e-4}}, one_laser(0, 1, 0), one_beam(1, 0),
                              turning_plate(0.5, rate));
    return std::atan2(x.y(), x.x()) - 0.5;
  };
  EXPECT_NEAR(azimuth(3), 9e-4, 1e-12);
  EXPECT_NEAR(azimuth(-6), -36e-4, 1e-12);
}

TEST(PlateTerms, AWobbleTiltsTheAxisAboutFixedDirections) {
  // φ = 90°: about x by b, about y by d. The beam goes to (0, 0, −5), 0 out: 3-4-5.
  const double angle = std::atan2(3, 4);
  const auto about_x = point_with("plate.wobble", {{"a", 1}, {"b", angle}}, one_laser(0, 0, 0),
                                  one_beam(5, 0), turning_plate(90 * kDegree));
  expect_point(about_x, 0, 3, -4);
  const auto about_y = point_with("plate.wobble", {{"c", 1}, {"d", angle}}, one_laser(0, 0, 0),
                                  one_beam(5, 0), turning_plate(90 * kDegree));
  expect_point(about_y, -3, 0, -4);
  const auto half_a_turn = point_with("plate.wobble", {{"a", angle}}, one_laser(0, 0, 0), one_beam(5, 0),
                                      turning_plate(180 * kDegree));
  expect_point(half_a_turn, 0, -3, -4);
}

TEST(PlateTerms, RockingShiftsTheScannerWithTheSquareOfTheRate) {
  // φ = 30°, 10 rad/s: 100 · (2e-5 √3/2, 1e-5 / 2).
  const auto x = point_with("plate.rocking", {{"a", 2e-5}, {"d", 1e-5}}, one_laser(-30 * kDegree, 0, 0),
                            one_beam(2, 0), turning_plate(30 * kDegree, -10));
  expect_point(x, 1e-3 * std::sqrt(3), 5e-4, -2);
}

TEST(BaseTerms, TheBaseDriftsAndSways) {
  // t = 1 s and f = 1/12 Hz: 30° of the sway.
  const auto x = point_with(
      "base.motion",
      {{"vx", 0.01}, {"vy", -0.02}, {"vz", 0.03}, {"ax", 0.2}, {"bx", 0.1}, {"by", 0.4}, {"f", 1.0 / 12}},
      one_laser(0, 0, 0), one_beam(2, 0), turning_plate(0));
  expect_point(x, 0.01 + 0.1 * std::sqrt(3) + 0.05, -0.02 + 0.2, -2 + 0.03);
}

}  // namespace
}  // namespace crisp
