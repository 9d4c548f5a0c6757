// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/report/motion_json.hpp"

#include <gtest/gtest.h>

#include <numbers>

namespace crisp {
namespace {

using namespace crisp::estimate;
using namespace crisp::report;

constexpr double kHalfTurn = std::numbers::pi;

/// Half a turn a second, read ten times a second, with a silence of two seconds from 1 s on.
PlateTrajectory interrupted_turning() {
  std::vector<double> times, angles;
  for (int i = 0; i <= 40; ++i) {
    if (i > 10 && i < 30) continue;
    times.push_back(100 + 0.1 * i);
    angles.push_back(kHalfTurn * 0.1 * i);
  }
  return {0, times, angles, 0.5};
}

TEST(MotionJson, CountsTimeFromTheFirstReadingAndAnglesInTurns) {
  const auto json = motion_json(interrupted_turning());
  EXPECT_EQ(json.at("time").front(), 0);
  EXPECT_NEAR(json.at("time").back().get<double>(), 4, 1e-9);
  EXPECT_NEAR(json.at("turns").back().get<double>(), 2, 1e-9);
  EXPECT_NEAR(json.at("rate").front().get<double>(), 0.5, 1e-3);
}

TEST(MotionJson, BreaksAtASilence) {
  const auto json = motion_json(interrupted_turning());
  ASSERT_EQ(json.at("time").size(), 11U + 1 + 11);
  EXPECT_TRUE(json.at("time")[11].is_null());
  EXPECT_TRUE(json.at("rate")[11].is_null());
}

TEST(MotionJson, ThinsOutManyReadings) {
  EXPECT_LE(motion_json(interrupted_turning(), 5).at("time").size(), 5U + 3);
}

TEST(CoverageJson, CountsBeamsByTheAnglesOfMirrorAndPlate) {
  const PlateTrajectory plate = interrupted_turning();
  Sample sample{.beams = {.range = {1, 1, 1},
                          .mirror_angle = {0.05F, 0.05F, -3.1F},
                          .time = {100.02, 100.04, 150},
                          .laser = {0, 0, 1},
                          .remission = {0, 0, 0},
                          .beam = {0, 0, 0}},
                .plate = &plate};
  const auto json = coverage_json(sample, {"left", "right"});
  EXPECT_EQ(json.at(0).at("laser"), "left");
  EXPECT_EQ(json.at(0).at("counts").at(18).at(0), 2)
      << "mirror 0° to 10°, plate 0° to 10°: it is at 3.6° and 7.2°";
  int all = 0;
  for (const auto& row : json.at(1).at("counts")) {
    for (const auto& n : row) all += n.get<int>();
  }
  EXPECT_EQ(all, 0) << "nobody knows where the plate was at 150 s";
}

}  // namespace
}  // namespace crisp
