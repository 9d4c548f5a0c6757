// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/estimate/scene_repeat.hpp"

#include <gtest/gtest.h>

#include <array>
#include <numbers>

#include "tests/pipeline/estimate/support.hpp"

namespace crisp {
namespace {

using namespace crisp::estimate;
using namespace crisp::simulate;

constexpr double kTurn = 2 * std::numbers::pi;

/// The period of a recording in the office whose encoder reads other angles than the plate has.
template <class Reading>
std::optional<SceneRepeat> period_of(Reading reading, double duration) {
  const auto simulated = simulate_measurements(misplaced_scanner(3, duration), office());
  std::vector<double> angles;
  for (std::size_t i = 0; i < simulated.plate.angles().size(); ++i)
    angles.push_back(reading(simulated.plate.times()[i], simulated.plate.angles()[i]));
  const PlateTrajectory plate(simulated.plate.epoch_ns(),
                              {simulated.plate.times().begin(), simulated.plate.times().end()},
                              std::move(angles), simulated.plate.max_gap());
  return scene_repeat({.beams = simulated.beams, .plate = &plate});
}

/// The encoder has `factor` times the rig's counts.
std::optional<SceneRepeat> period_with(double factor, double duration = 6) {
  return period_of([factor](double, double angle) { return factor * angle; }, duration);
}

TEST(SceneRepeat, IsATurnWhereTheCountsAreRight) {
  const auto period = period_with(1);
  ASSERT_TRUE(period);
  EXPECT_NEAR(period->angle / kTurn, 1, 0.003);
  EXPECT_FALSE(contradicts_counts(*period));
}

TEST(SceneRepeat, IsFoundWhereTheCountsAreWrongByAFewPerCentOrByAFactor) {
  for (const double factor : {0.97, 1.04, 2.0, 0.5, 4.0}) {
    const auto period = period_with(factor, 8);
    ASSERT_TRUE(period) << factor;
    EXPECT_NEAR(period->angle / kTurn / factor, 1, 0.004) << factor;
    EXPECT_TRUE(contradicts_counts(*period)) << factor;
  }
}

TEST(SceneRepeat, IsNoMultipleWhereTheSceneNearlyRepeatsAfterATurn) {
  const SceneRepeat of_slips{
      .angle = 3.976 * kTurn, .miss = 0.043, .at_2pi = 0.074, .close_at_2pi = 0.07, .elsewhere = 0.3};
  EXPECT_FALSE(contradicts_counts(of_slips));
  SceneRepeat of_counts = of_slips;
  of_counts.at_2pi = of_counts.close_at_2pi = 0.28;
  EXPECT_TRUE(contradicts_counts(of_counts));
}

TEST(SceneRepeat, IsNoMultipleWhereNoBeamsAreCloseAfterATurn) {
  SceneRepeat period{
      .angle = 3 * kTurn, .miss = 0.023, .at_2pi = 0.057, .close_at_2pi = 0, .elsewhere = 0.07};
  EXPECT_FALSE(contradicts_counts(period)) << "at a constant rate they lie between those of the turn before";
  period.close_at_2pi = 0.057;
  EXPECT_TRUE(contradicts_counts(period));
}

TEST(SceneRepeat, IsNoPartOfATurnWhereTheSceneRepeatsAfterNoAngle) {
  SceneRepeat period{
      .angle = 0.506 * kTurn, .miss = 0.118, .at_2pi = 0.102, .close_at_2pi = 0.102, .elsewhere = 0.130};
  EXPECT_FALSE(contradicts_counts(period));
  period.miss = 0.036;
  EXPECT_TRUE(contradicts_counts(period));
}

TEST(SceneRepeat, IsUndeterminedAtAnEvenRateAtWhichFewAnglesRecur) {
  constexpr double kRate = 5;  // turns a second: ten scans a turn
  EXPECT_FALSE(period_of([](double time, double) { return kTurn * kRate * time; }, 6));
}

TEST(SceneRepeat, DoesNotBlameTheCountsForSlips) {
  for (const double size : {2.0, 4.0, 7.0}) {
    const auto with_slips = [size](double time, double angle) {
      double slipped = 0;
      constexpr std::array at = {0.9, 1.9, 3.2, 4.1, 5.6, 6.8};
      for (std::size_t k = 0; k < at.size(); ++k)
        if (time > at[k]) slipped += (k % 3 == 1 ? -1 : 1) * size * kTurn / 360;
      return angle + slipped;
    };
    const auto period = period_of(with_slips, 8);
    ASSERT_TRUE(period) << size;
    EXPECT_FALSE(contradicts_counts(*period) && period->angle > 1.5 * kTurn) << size << " degrees";
  }
}

TEST(SceneRepeat, IsUndeterminedByLessThanATurn) { EXPECT_FALSE(period_with(1, 0.2)); }

}  // namespace
}  // namespace crisp
