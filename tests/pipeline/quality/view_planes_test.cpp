// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/quality/view_planes.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <random>

namespace crisp {
namespace {

constexpr double kNoise = 0.012;  // [m]

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
    if (!piece(1, 0, 0, 0.02, seed).continues(piece(1, 1, 0, 0.02, seed + 1000), 0)) ++refused;
  }
  EXPECT_LE(refused, 2);  // four standard deviations of χ² of three degrees of freedom
}

TEST(ViewPlanes, DoNotContinueBeyondAStepOrABend) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    EXPECT_FALSE(piece(1, 0, 0, 0, seed).continues(piece(1, 1, 0.05, 0, seed + 1000), 0.5));
    EXPECT_FALSE(piece(1, 0, 0, 0.2, seed).continues(piece(1, 1, 0.2, 0, seed + 1000), 0.5));
  }
}

TEST(ViewPlanes, ContinueOverBumpsThatAreAllowed) {
  EXPECT_TRUE(piece(1, 0, 0, 0, 1).continues(piece(1, 1, 0.008, 0, 2), 0.5));
  EXPECT_FALSE(piece(1, 0, 0, 0, 1).continues(piece(1, 1, 0.03, 0, 2), 0.1));
}

TEST(ViewPlanes, AreNotComparedBetweenViews) {
  // How far views are apart is what the calibration is to find.
  EXPECT_TRUE(piece(1, 0, 0, 0, 1).continues(piece(2, 1, 0.1, 0, 2), 0.5));
  ViewPlanes both = piece(1, 0, 0, 0, 1);
  both += piece(2, 0, 0.1, 0, 2);
  ViewPlanes beyond = piece(1, 1, 0, 0, 3);
  beyond += piece(2, 1, 0.1, 0, 4);
  EXPECT_TRUE(both.continues(beyond, 0.5));
}

TEST(ViewPlanes, OfFewBeamsSayNothing) {
  EXPECT_TRUE(piece(1, 0, 0, 0, 1).continues(piece(1, 1, 1, 0, 2, 3), 0));
  EXPECT_TRUE(ViewPlanes().continues(piece(1, 0, 0, 0, 1), 0));
  EXPECT_TRUE(ViewPlanes().continues(ViewPlanes(), std::numeric_limits<double>::infinity()));
}

}  // namespace
}  // namespace crisp
