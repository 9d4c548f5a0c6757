// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/devices/rotating_head.hpp"

#include <gtest/gtest.h>

#include <numbers>

namespace crisp {
namespace {

using namespace crisp::devices;

constexpr double kTurn = 2 * std::numbers::pi;

TEST(RotatingHead, ContinuesAzimuthsOverWholeTurns) {
  RotatingHead head(0, 1);
  for (const double azimuth : {0.0, 2.0, -2.5, 0.5})
    head.add_azimuth(static_cast<double>(head.azimuths()), azimuth);
  const auto rest = head.take_rest();
  EXPECT_NEAR(rest.plate.angles().back(), 0.5 + kTurn, 1e-12);
  EXPECT_NEAR(head.turns(), 1 + 0.5 / kTurn, 1e-12);
  EXPECT_EQ(head.contradictions(), 0U);
}

TEST(RotatingHead, CountsStepsAgainstTheSenseOfMostAndDifferencesAtOneInstant) {
  RotatingHead head(0, 1);
  for (const double azimuth : {0.0, -0.1, -0.2, -0.15, -0.3})
    head.add_azimuth(static_cast<double>(head.azimuths()), azimuth);
  EXPECT_EQ(head.contradictions(), 1U);
  head.add_azimuth(4, -0.2);
  EXPECT_EQ(head.contradictions(), 2U);
}

TEST(RotatingHead, LeavesOutAzimuthsThatAreNotLater) {
  RotatingHead head(0, 1);
  for (const double time : {1.0, 1.0, 0.5, 2.0}) head.add_azimuth(time, time);
  EXPECT_EQ(head.azimuths(), 2U);
}

}  // namespace
}  // namespace crisp
