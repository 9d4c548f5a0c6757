// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/clock/mirror_smoothing.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

namespace crisp {
namespace {

using namespace crisp::clock;

struct SimulatedMirror {
  std::vector<MirrorStamp> stamps;
  std::vector<double> times;    ///< [s] true
  std::vector<double> periods;  ///< [s] true, at the stamp
};

/// Turns whose period at time t is `period(t)`, stamped with Gaussian jitter [s] and now and then late.
SimulatedMirror simulate(std::uint64_t seed, int turns, const std::function<double(double)>& period,
                         double jitter, double late_by, double late_chance, double lost_chance) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<> uniform(0, 1);
  std::normal_distribution<> gauss(0, 1);
  SimulatedMirror mirror;
  double t = 100;
  for (int turn = 0; turn < turns; ++turn) {
    const bool lost = uniform(random) < lost_chance;
    const double late = uniform(random) < late_chance ? late_by : 0;
    const double stamp = 1e-6 * std::round(1e6 * (t + jitter * gauss(random) + late));
    if (!lost) {
      mirror.stamps.push_back({.turn = turn, .time = stamp});
      mirror.times.push_back(t);
      mirror.periods.push_back(period(t));
    }
    double middle = t + 0.5 * period(t);
    t += period(middle);
  }
  return mirror;
}

struct Spread {
  double time = 0;    ///< [s] root mean square
  double period = 0;  ///< [s] root mean square
};

Spread errors_of(const SimulatedMirror& mirror, std::size_t half_width = 0) {
  const auto turns = smooth_mirror(mirror.stamps, {.half_width = half_width, .nominal_period = 0.02});
  EXPECT_EQ(turns.size(), mirror.times.size());
  Spread spread;
  const auto n = static_cast<double>(turns.size());
  for (std::size_t i = 0; i < turns.size(); ++i) {
    spread.time += std::pow(turns[i].time - mirror.times[i], 2) / n;
    spread.period += std::pow(turns[i].period - mirror.periods[i], 2) / n;
  }
  return {std::sqrt(spread.time), std::sqrt(spread.period)};
}

double wandering(double t) { return 0.0201145 * (1 + 2e-3 * std::sin(1.5 * t)); }

TEST(MirrorTurns, FollowAMirrorThatWandersByTwoPermilleWithinSeconds) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const auto errors = errors_of(simulate(seed, 400, wandering, 5e-6, 0, 0, 0));
    EXPECT_LT(errors.time, 4e-6);    // a parabola through five stamps leaves 0.70 of 5 us, through more less
    EXPECT_LT(errors.period, 2e-6);  // the slope through five leaves 0.32
  }
}

TEST(MirrorTurns, AreNotMovedByStampsThatNowAndThenComeLate) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {  // as the LMS111 does: every twentieth by 25 us
    const auto clean = errors_of(simulate(seed, 400, wandering, 4e-6, 0, 0, 0));
    const auto late = errors_of(simulate(seed, 400, wandering, 4e-6, 25e-6, 0.05, 0));
    EXPECT_LT(late.time, clean.time + 2e-6);
  }
}

TEST(MirrorTurns, AreKnownAcrossLostScans) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const auto errors = errors_of(simulate(seed, 400, wandering, 5e-6, 0, 0, 0.2));
    EXPECT_LT(errors.time, 4.5e-6);
    EXPECT_LT(errors.period, 3e-6);
  }
}

TEST(MirrorTurns, AreSmoothedOverFewWhereTheMirrorSwings) {
  // As the TiM781S: a swing of 45 us in the period, nine turns long. Over ten turns it would be smoothed
  // away.
  const auto swinging = [](double t) { return 0.0666 + 45e-6 * std::sin(2 * M_PI * t / (9 * 0.0666)); };
  const auto mirror = simulate(1, 700, swinging, 5e-6, 0, 0, 0);
  EXPECT_LT(errors_of(mirror).time, 0.3 * errors_of(mirror, 10).time);
  EXPECT_LT(errors_of(mirror).time, 8e-6);
}

TEST(MirrorTurns, OfALoneScanAreTheNominalOnes) {
  const std::vector<MirrorStamp> one = {{5, 12.5}};
  const auto turns = smooth_mirror(one, {.nominal_period = 0.02});
  ASSERT_EQ(turns.size(), 1u);
  EXPECT_EQ(turns[0].time, 12.5);
  EXPECT_EQ(turns[0].period, 0.02);
}

TEST(MirrorTurns, OfTwoScansLieOnTheLineThroughThem) {
  const std::vector<MirrorStamp> two = {{5, 12.5}, {7, 12.5402}};
  const auto turns = smooth_mirror(two, {.nominal_period = 0.02});
  ASSERT_EQ(turns.size(), 2u);
  EXPECT_NEAR(turns[1].time, 12.5402, 1e-12);
  EXPECT_NEAR(turns[1].period, 0.0201, 1e-12);
}

}  // namespace
}  // namespace crisp
