// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/data/plate_trajectory.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "pipeline/data/error.hpp"

namespace crisp {
namespace {

PlateTrajectory parabola() {
  std::vector<double> times = {0, 0.9, 2.1, 3, 4, 5.2, 6};
  std::vector<double> angles;
  for (double t : times) angles.push_back(1 + 2 * t - 0.5 * t * t);
  return {0, times, angles, 1.5};
}

TEST(PlateTrajectory, FollowsAParabolaExactlyBetweenInnerReadings) {
  const auto plate = parabola();
  for (double t = 0.9; t <= 5.2; t += 0.01) {
    const auto state = plate.at(t);
    ASSERT_TRUE(state) << t;
    EXPECT_NEAR(state->angle, 1 + 2 * t - 0.5 * t * t, 1e-12);
    EXPECT_NEAR(state->rate, 2 - t, 1e-12);
  }
}

TEST(PlateTrajectory, DoesNotExtrapolate) {
  const auto plate = parabola();
  EXPECT_FALSE(plate.at(-1e-9));
  EXPECT_FALSE(plate.at(6 + 1e-9));
  EXPECT_FALSE(plate.at(std::nan("")));
  EXPECT_TRUE(plate.at(0));
  EXPECT_TRUE(plate.at(6));
  EXPECT_FALSE(PlateTrajectory().at(0));
}

TEST(PlateTrajectory, DoesNotInterpolateAcrossALongSilence) {
  const PlateTrajectory plate(0, {0, 1, 3, 4}, {0, 1, 3, 4}, 1.5);
  EXPECT_TRUE(plate.at(0.5));
  EXPECT_FALSE(plate.at(2));
  EXPECT_TRUE(plate.at(3.5));
}

TEST(PlateTrajectory, ItsCursorAnswersAsItselfInAnyOrder) {
  std::vector<double> times;
  std::vector<double> angles;
  for (int i = 0; i < 200; ++i) {
    times.push_back(i * 0.01 + 0.001 * (i % 3));
    angles.push_back(std::sin(times.back()));
  }
  const PlateTrajectory plate(0, times, angles, 0.02);
  PlateTrajectory::Cursor cursor(plate);
  for (double t : {0.0, 0.5, 0.51, 0.505, 1.9, 0.1, 1.0, 2.5, -1.0, 1.99, 0.0}) {
    const auto direct = plate.at(t);
    const auto walked = cursor.at(t);
    ASSERT_EQ(direct.has_value(), walked.has_value()) << t;
    if (direct) {
      EXPECT_DOUBLE_EQ(direct->angle, walked->angle);
    }
  }
}

TEST(PlateTrajectory, RefusesTimesThatDoNotAscend) {
  EXPECT_THROW(PlateTrajectory(0, {0, 1, 1}, {0, 1, 2}, 1), Error);
  EXPECT_THROW(PlateTrajectory(0, {0, 1}, {0}, 1), Error);
}

}  // namespace
}  // namespace crisp
