// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <vector>

#include <crisp/error.hpp>
#include <crisp/plate_trajectory.hpp>

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

/// The reading with which the arc of t begins, by exhaustive search.
std::optional<std::size_t> interval_by_search(const PlateTrajectory& plate, double t) {
  const auto times = plate.times();
  for (std::size_t i = times.size() - 1; i-- > 0;) {
    if (t >= times[i] && t <= times.back()) {
      return times[i + 1] - times[i] <= plate.max_gap() ? std::optional(i) : std::nullopt;
    }
  }
  return std::nullopt;
}

void expect_intervals_as_by_looking(const std::vector<double>& times, double max_gap) {
  const PlateTrajectory plate(0, times, std::vector<double>(times.size(), 0.0), max_gap);
  std::vector<double> requested = {times.front() - 1, times.back() + 1};
  for (std::size_t i = 0; i < times.size(); ++i) {
    requested.insert(requested.end(),
                     {times[i], std::nextafter(times[i], -1e9), std::nextafter(times[i], 1e9)});
    if (i > 0) requested.push_back(0.3 * times[i - 1] + 0.7 * times[i]);
  }
  for (const double t : requested) EXPECT_EQ(plate.interval(t), interval_by_search(plate, t)) << t;
}

TEST(PlateTrajectory, FindsTheIntervalOfATimeAmongReadingsThatAreAboutEven) {
  std::vector<double> times;
  for (int i = 0; i < 500; ++i) times.push_back(1e5 + i * 0.002 + 0.0015 * std::sin(7.0 * i));
  expect_intervals_as_by_looking(times, 0.02);
}

TEST(PlateTrajectory, FindsTheIntervalOfATimeAmongReadingsThatCrowd) {
  std::vector<double> times;  // two recordings an hour apart: all are in the first and the last part
  for (int i = 0; i < 300; ++i) times.push_back(i * 0.002);
  for (int i = 0; i < 300; ++i) times.push_back(3600 + i * 0.002);
  expect_intervals_as_by_looking(times, 0.02);
}

TEST(PlateTrajectory, KeepsItsDirectionAtStandstillAndReversesOverACentesimalRadian) {
  // Forth, still but for the noise of a count, back; and after a silence forth again, from another angle.
  const PlateTrajectory plate(0, {0, 1, 2, 3, 4, 5, 6, 7, 17, 18, 19},
                              {0, 0.5, 1, 0.999, 1, 0.995, 0.99, 0, 9, 9.001, 9.1}, 2);
  const auto direction = [&](double t) { return plate.at(t)->direction; };
  EXPECT_NEAR(direction(0), 1, 1e-12) << "as it turns first";
  EXPECT_NEAR(direction(2), 1, 1e-12);
  EXPECT_NEAR(direction(3), 0.8, 1e-9);
  EXPECT_NEAR(direction(4), 1, 1e-9);
  EXPECT_NEAR(direction(5), 0, 1e-9) << "half of the travel of a reversal";
  EXPECT_NEAR(direction(5.5), -0.5, 1e-9);
  EXPECT_NEAR(plate.at(5.5)->direction_rate, -1, 1e-9);
  EXPECT_NEAR(direction(6.9), -1, 1e-9);
  EXPECT_NEAR(direction(17), 1, 1e-9) << "of another recording";
  EXPECT_NEAR(direction(19), 1, 1e-9);
}

TEST(PlateTrajectory, HasNoDirectionWhereThePlateNeverTurns) {
  const PlateTrajectory plate(0, {0, 1, 2}, {1, 1.002, 1}, 2);
  EXPECT_NEAR(plate.at(0)->direction, 0, 1e-12);
  EXPECT_LT(std::abs(plate.at(1)->direction), 0.5);
}

TEST(PlateTrajectory, RefusesTimesThatDoNotAscend) {
  EXPECT_THROW(PlateTrajectory(0, {0, 1, 1}, {0, 1, 2}, 1), Error);
  EXPECT_THROW(PlateTrajectory(0, {0, 1}, {0}, 1), Error);
}

}  // namespace
}  // namespace crisp
