// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/quality/view_planes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace crisp {
namespace {

using namespace crisp::quality;

constexpr double kNoise = 0.012;  // [m]
const Plane kHorizontal;          // z = 0

/// A piece of 1 m about x, at z = height + slope · x, as one view sees it.
ViewPlanes piece(std::uint32_t view, double x, double height, double slope, unsigned seed, int beams = 300) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> place(-0.5, 0.5);
  std::normal_distribution<double> error(0, kNoise);
  ViewPlanes planes;
  for (int i = 0; i < beams; ++i) {
    const double at = x + place(random);
    planes.add(view, {at, place(random), height + slope * at + error(random)}, 1 / (kNoise * kNoise));
  }
  return planes;
}

TEST(ViewPlanes, ContinueInAPieceOfTheSamePlane) {
  int refused = 0;
  for (unsigned seed = 0; seed < 200; ++seed) {
    if (!piece(1, 0, 0, 0.02, seed).continues(piece(1, 1, 0, 0.02, seed + 1000), kHorizontal, 0)) ++refused;
  }
  EXPECT_LE(refused, 2);  // four standard deviations of χ² of three degrees of freedom
}

TEST(ViewPlanes, DoNotContinueBeyondAStepOrABend) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    EXPECT_FALSE(piece(1, 0, 0, 0, seed).continues(piece(1, 1, 0.05, 0, seed + 1000), kHorizontal, 0.5));
    EXPECT_FALSE(piece(1, 0, 0, 0.2, seed).continues(piece(1, 1, 0.2, 0, seed + 1000), kHorizontal, 0.5));
  }
}

TEST(ViewPlanes, ContinueOverBumpsThatAreAllowed) {
  EXPECT_TRUE(piece(1, 0, 0, 0, 1).continues(piece(1, 1, 0.008, 0, 2), kHorizontal, 0.5));
  EXPECT_FALSE(piece(1, 0, 0, 0, 1).continues(piece(1, 1, 0.03, 0, 2), kHorizontal, 0.1));
}

TEST(ViewPlanes, AreNotComparedBetweenViews) {
  // How far views are apart is what the calibration is to find.
  EXPECT_TRUE(piece(1, 0, 0, 0, 1).continues(piece(2, 1, 0.1, 0, 2), kHorizontal, 0.5));
  ViewPlanes both = piece(1, 0, 0, 0, 1);
  both += piece(2, 0, 0.1, 0, 2);
  ViewPlanes beyond = piece(1, 1, 0, 0, 3);
  beyond += piece(2, 1, 0.1, 0, 4);
  EXPECT_TRUE(both.continues(beyond, kHorizontal, 0.5));
}

TEST(ViewPlanes, OfALineContinueAlongItsCurve) {
  // One beam of a cone meets a ceiling in a hyperbola. The cone holds its points, too, but is no plane.
  const auto arc = [](double from, unsigned seed) {
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> place(from, from + 2);
    std::normal_distribution<double> error(0, kNoise);
    ViewPlanes planes;
    for (int i = 0; i < 300; ++i) {
      const double x = place(random);
      const double y = std::sqrt(4 + x * x);
      const Eigen::Vector3d direction = Eigen::Vector3d(x, y, 2).normalized();
      planes.add(1, Eigen::Vector3d(x, y, 0) + error(random) * direction,
                 1 / std::pow(kNoise * direction.z(), 2));
    }
    return planes;
  };
  int refused = 0;
  for (unsigned seed = 0; seed < 100; ++seed) {
    if (!arc(-2, seed).continues(arc(0, seed + 100), kHorizontal, 0.2)) ++refused;
  }
  EXPECT_LE(refused, 5);
}

TEST(ViewPlanes, OfFewBeamsSayNothing) {
  EXPECT_TRUE(piece(1, 0, 0, 0, 1).continues(piece(1, 1, 1, 0, 2, 3), kHorizontal, 0));
  EXPECT_TRUE(ViewPlanes().continues(piece(1, 0, 0, 0, 1), kHorizontal, 0));
  EXPECT_TRUE(ViewPlanes().continues(ViewPlanes(), kHorizontal, std::numeric_limits<double>::infinity()));
}

}  // namespace
}  // namespace crisp
