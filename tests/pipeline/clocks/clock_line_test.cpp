// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/clocks/clock_line.hpp"

#include <gtest/gtest.h>

#include "pipeline/clocks/lower_hull.hpp"
#include "tests/pipeline/clocks/linear_program.hpp"
#include "tests/support/simulated_stamps.hpp"

namespace crisp {
namespace {

using namespace crisp::clocks;
using namespace test;  // NOLINT(google-build-using-namespace)

// (0, 1), (1, 0), (3, 1), (4, 3) make the lower hull of these; the mean of the times is 2.
const std::vector<Stamp> kByHand = {{0, 1e-5}, {1, 0}, {2, 2e-5}, {3, 1e-5}, {4, 3e-5}};

TEST(ClockLine, IsTheHullsEdgeAtTheMeanOfTheStamps) {
  for (const auto& line : {line_by_convex_hull(kByHand, 2), test::line_by_linear_program(kByHand, 2)}) {
    EXPECT_NEAR(line.slope, 0.5e-5, 1e-18);
    EXPECT_NEAR(line.at_center, 0.5e-5, 1e-18);
    EXPECT_NEAR(line.lead(4), 1.5e-5, 1e-18);
  }
}

TEST(HullSlope, IsThatOfTheLineHoweverSteep) {
  EXPECT_NEAR(hull_slope(kByHand, 2), 0.5e-5, 1e-18);
  EXPECT_NEAR(hull_slope(kByHand, 3.5), 2e-5, 1e-18);
  EXPECT_EQ(hull_slope(std::vector<Stamp>{{0, 1}, {1, 3}}, 0.5), 2) << "a line's slope is at most kMaxSkew";
  EXPECT_EQ(hull_slope(std::vector<Stamp>{{5, 1}}, 5), 0);
}

TEST(ClockLine, OfTwoWaysToFindItIsTheSameToRounding) {
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    Random random(seed);
    const double skew = std::uniform_real_distribution<>(-250e-6, 250e-6)(random);
    const auto delays = seed % 2 ? exponential_delays(3e-4) : bursty_delays(2e-4, 5e-3, 40, 0.01);
    const auto stamps = simulated_stamps(seed, 1 + static_cast<double>(seed % 20), 50, skew, delays);
    const double mean = mean_device_time(stamps);
    const auto hull = line_by_convex_hull(stamps, mean);
    const auto programme = test::line_by_linear_program(stamps, mean);
    EXPECT_NEAR(hull.at_center, programme.at_center, 1e-15) << "seed " << seed;
    EXPECT_NEAR(hull.slope, programme.slope, 1e-15) << "seed " << seed;
  }
}

TEST(ClockLine, LiesBelowAllStampsAndNoOtherSuchLineIsNearerToThem) {
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    const auto stamps = simulated_stamps(seed, 2, 20, 1e-4, exponential_delays(1e-3));
    const double mean = mean_device_time(stamps);
    const auto line = line_by_convex_hull(stamps, mean);
    for (const auto& stamp : stamps) ASSERT_GE(stamp.lead, line.lead(stamp.device) - 1e-15);
    // The best of all lines through two stamps that have no stamp below them: every vertex of the programme.
    double best = -HUGE_VAL;
    for (const auto& a : stamps) {
      for (const auto& b : stamps) {
        if (b.device <= a.device) continue;
        const ClockLine other{a.device, a.lead, (b.lead - a.lead) / (b.device - a.device)};
        const bool below = std::all_of(stamps.begin(), stamps.end(), [&](const Stamp& s) {
          return s.lead >= other.lead(s.device) - 1e-15;
        });
        if (below) best = std::max(best, other.lead(mean));
      }
    }
    EXPECT_NEAR(line.at_center, best, 1e-15) << "seed " << seed;
  }
}

TEST(ClockLine, FindsSkewsWithinOnePartPerMillionInTenMinutes) {
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    Random random(seed);
    const double skew = std::uniform_real_distribution<>(-250e-6, 250e-6)(random);
    const Delays delays[] = {exponential_delays(5e-4), gamma_delays(3, 3e-4),
                             bursty_delays(3e-4, 20e-3, 200, 0.002)};
    const auto stamps = simulated_stamps(seed, 600, 15, skew, delays[seed % 3]);
    const auto line = line_by_convex_hull(stamps, mean_device_time(stamps));
    EXPECT_NEAR(line.slope, skew, 1e-6) << "seed " << seed;
  }
}

TEST(ClockLine, IsNeverSteeperThanACrystalCanBe) {
  const std::vector<Stamp> stamps = {
      {0, 0}, {0.01, 1e-3}, {0.02, 0.5e-3}};  // two stamps would give 25000 ppm
  const auto hull = line_by_convex_hull(stamps, 0.01);
  const auto programme = test::line_by_linear_program(stamps, 0.01);
  EXPECT_DOUBLE_EQ(hull.slope, kMaxSkew);
  EXPECT_DOUBLE_EQ(programme.slope, kMaxSkew);
  EXPECT_NEAR(hull.at_center, 0.01 * kMaxSkew, 1e-18);
  EXPECT_NEAR(programme.at_center, 0.01 * kMaxSkew, 1e-18);
}

TEST(ClockLine, IsLevelWhereAllStampsAreOfOneInstant) {
  const std::vector<Stamp> stamps = {{5, 3e-3}, {5, 1e-3}, {5, 2e-3}};
  for (const auto& line : {line_by_convex_hull(stamps, 5), test::line_by_linear_program(stamps, 5)}) {
    EXPECT_EQ(line.slope, 0);
    EXPECT_EQ(line.at_center, 1e-3);
  }
}

TEST(HullClock, KnowsAfterEachStampWhatTheBatchKnows) {
  const auto stamps = simulated_stamps(7, 20, 50, -80e-6, bursty_delays(2e-4, 3e-3, 30, 0.01));
  HullClock clock;
  for (std::size_t n = 1; n <= stamps.size(); ++n) {
    clock.add(stamps[n - 1]);
    const std::vector<Stamp> seen(stamps.begin(), stamps.begin() + static_cast<std::ptrdiff_t>(n));
    const auto batch = line_by_convex_hull(seen, mean_device_time(seen));
    ASSERT_NEAR(clock.line().slope, batch.slope, 1e-15) << n;
    ASSERT_NEAR(clock.line().lead(10), batch.lead(10), 1e-14) << n;
  }
}

TEST(LowerHull, WithABendKeepsEveryStampThatACurveCanTouch) {
  constexpr double kBend = 1e-6;
  const auto stamps = simulated_stamps(3, 30, 20, 0, exponential_delays(1e-4));
  LowerHull hull(kBend);
  for (const auto& stamp : stamps) hull.add(stamp);
  const auto kept = hull.vertices();
  ASSERT_LT(kept.size(), stamps.size() / 3);
  Random random(1);
  for (int i = 0; i < 1000; ++i) {  // curves of any bend up to that one rest on one of the kept stamps
    const double bend = std::uniform_real_distribution<>(0, kBend)(random);
    const double slope = std::uniform_real_distribution<>(-1e-4, 1e-4)(random);
    const auto height = [&](const Stamp& s) {
      return s.lead + bend / 2 * s.device * s.device - slope * s.device;
    };
    const auto lower = [&](const Stamp& a, const Stamp& b) { return height(a) < height(b); };
    EXPECT_EQ(height(*std::min_element(kept.begin(), kept.end(), lower)),
              height(*std::min_element(stamps.begin(), stamps.end(), lower)));
  }
}

}  // namespace
}  // namespace crisp
