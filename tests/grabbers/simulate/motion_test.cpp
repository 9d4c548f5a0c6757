// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/simulate/motion.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include <crisp/error.hpp>

namespace crisp {
namespace {

using namespace crisp::simulate;

constexpr double kTurn = 2 * std::numbers::pi;

TEST(Motion, FollowsAHandWorkedRamp) {
  // From rest to 2 rad/s in 4 s along u²(3 − 2u): after 1 s the rate is 2 · (1/16)(3 − 1/2) = 0.3125, the
  // angle 4 · 2 · (u³ − u⁴/2) = 0.109375; after 4 s it has turned by the mean rate times 4 s.
  const Motion motion({{0, 0}, {4, 2}}, 1);
  EXPECT_NEAR(motion.at(1)->rate, 0.3125, 1e-15);
  EXPECT_NEAR(motion.at(1)->angle, 1.109375, 1e-15);
  EXPECT_NEAR(motion.at(4)->angle, 5, 1e-15);
  EXPECT_NEAR(motion.at(6)->angle, 9, 1e-15) << "goes on at the last rate";
  EXPECT_NEAR(motion.at(-3)->angle, 1, 1e-15) << "came at the first rate";
}

TEST(Motion, KeepsItsDirectionAtStandstillAndReversesOverACentesimalRadian) {
  // Forth at 1 rad/s to 3 s, still for a second, and back from 5 s on: from 6 s at −1 rad/s.
  const Motion motion({{2, 1}, {3, 0}, {4, 0}, {5, 0}, {6, -1}, {7, -1}, {8, 1}});
  EXPECT_EQ(motion.at(1)->direction, 1);
  EXPECT_EQ(motion.at(3.5)->direction, 1);
  EXPECT_EQ(motion.at(3.5)->direction_rate, 0);
  double reversed = 5;
  while (motion.at(5)->angle - motion.at(reversed)->angle < 0.005) reversed += 1e-5;
  EXPECT_NEAR(motion.at(reversed)->direction, 0, 1e-3) << "after half the travel of a reversal";
  EXPECT_EQ(motion.at(6.5)->direction, -1);
  EXPECT_NEAR(motion.at(7.5)->direction, -1, 1e-12) << "stands: the turning point between both rates";
  EXPECT_EQ(motion.at(8)->direction, 1);
  EXPECT_EQ(motion.at(9)->direction, 1);
}

class AnyMotion : public testing::TestWithParam<MotionKind> {};

TEST_P(AnyMotion, HasRatesThatAreTheSlopesOfItsAngleAndDirection) {
  const Motion motion = make_motion({.kind = GetParam()}, 10, 3);
  constexpr double kStep = 1e-4;
  for (double t = -0.5; t < 10.5; t += 0.0137) {
    const double slope = (motion.at(t + kStep)->angle - motion.at(t - kStep)->angle) / (2 * kStep);
    EXPECT_NEAR(slope, motion.at(t)->rate, 1e-4) << t;  // third derivatives: 2 turns a second in 0.7 s
    const double change = motion.at(t + kStep)->direction - motion.at(t - kStep)->direction;
    if (std::abs(motion.at(t + kStep)->direction) < 1 && std::abs(motion.at(t - kStep)->direction) < 1) {
      EXPECT_NEAR(change / (2 * kStep), motion.at(t)->direction_rate, 0.1) << t;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Kinds, AnyMotion,
                         testing::Values(MotionKind::constant, MotionKind::varying, MotionKind::reversal,
                                         MotionKind::stop_and_go));

struct Extent {
  double slowest = 1e9;
  double fastest = -1e9;
};

Extent extent(const Motion& motion, double duration) {
  Extent rates;
  for (double t = 0; t <= duration; t += 0.01) {
    rates.slowest = std::min(rates.slowest, motion.at(t)->rate / kTurn);
    rates.fastest = std::max(rates.fastest, motion.at(t)->rate / kTurn);
  }
  return rates;
}

TEST(MakeMotion, VariesOverMostOfItsRangeAndNeverBeyond) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const auto rates = extent(make_motion({}, 10, seed), 10);
    EXPECT_GE(rates.slowest, 0) << seed;
    EXPECT_LE(rates.fastest, 2) << seed;
    EXPECT_GT(rates.fastest - rates.slowest, 1) << seed;
  }
}

TEST(MakeMotion, ReversesBetweenBothDirections) {
  const auto rates = extent(make_motion({.kind = MotionKind::reversal, .max_rate = 1}, 10, 1), 10);
  EXPECT_NEAR(rates.slowest, -1, 1e-12);
  EXPECT_NEAR(rates.fastest, 1, 1e-12);
}

TEST(MakeMotion, StopsAndGoes) {
  const Motion motion = make_motion({.kind = MotionKind::stop_and_go, .hold_time = 0.5}, 10, 1);
  EXPECT_EQ(motion.at(0.25)->rate, 0);
  EXPECT_NEAR(motion.at(1.75)->rate, 2 * kTurn, 1e-12);
  EXPECT_NEAR(motion.at(3.25)->rate, 0, 1e-12);
}

TEST(MakeMotion, RefusesWhatCannotTurn) {
  EXPECT_THROW(make_motion({.min_rate = 3, .max_rate = 2}, 10, 1), Error);
  EXPECT_THROW(make_motion({.max_rate = std::nan("")}, 10, 1), Error);
  EXPECT_THROW(make_motion({.change_time = 0}, 10, 1), Error);
  EXPECT_THROW(make_motion({}, 0, 1), Error);
  EXPECT_THROW(Motion({{1, 0}, {1, 1}}), Error);
  EXPECT_THROW(Motion({}), Error);
}

}  // namespace
}  // namespace crisp
