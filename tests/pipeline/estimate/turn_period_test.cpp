// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/estimate/turn_period.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "tests/pipeline/estimate/support.hpp"

namespace crisp {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;

/// The period of a recording in the office whose encoder has `factor` times the rig's counts.
std::optional<TurnPeriod> period_with(double factor, double duration = 6) {
  const auto simulated = simulate_measurements(misplaced_scanner(3, duration), office());
  std::vector<double> angles;
  for (const double angle : simulated.plate.angles()) angles.push_back(factor * angle);
  const PlateTrajectory plate(simulated.plate.epoch_ns(),
                              {simulated.plate.times().begin(), simulated.plate.times().end()},
                              std::move(angles), simulated.plate.max_gap());
  return turn_period({.beams = simulated.beams, .plate = &plate});
}

TEST(TurnPeriod, IsATurnWhereTheCountsAreRight) {
  const auto period = period_with(1);
  ASSERT_TRUE(period);
  EXPECT_NEAR(period->angle / kTurn, 1, 0.003);
  EXPECT_FALSE(contradicts_counts(*period));
}

TEST(TurnPeriod, IsFoundWhereTheCountsAreWrongByAFewPerCentOrByAFactor) {
  for (const double factor : {0.97, 1.04, 2.0, 0.5, 4.0}) {
    const auto period = period_with(factor, 8);
    ASSERT_TRUE(period) << factor;
    EXPECT_NEAR(period->angle / kTurn / factor, 1, 0.004) << factor;
    EXPECT_TRUE(contradicts_counts(*period)) << factor;
  }
}

TEST(TurnPeriod, IsUndeterminedByLessThanATurn) { EXPECT_FALSE(period_with(1, 0.2)); }

}  // namespace
}  // namespace crisp
