// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/diagnose/scans/passes.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "plugins/diagnose/scans/passes_stage.hpp"
#include "tests/plugins/diagnose/scans/tilting_scene.hpp"

namespace crisp {
namespace {

using namespace crisp::data;
using namespace crisp::diagnose;

constexpr double kStep = 0.1 * kDegree;
constexpr double kNoiseOfPasses = 0.01;

/// Up from 30° to 80° and down again, one step per scan. On the downward pass the tilt is smaller than its
/// reading by `behind` at the lowest reading, and by `more` in addition at the highest.
std::vector<Pass> up_and_down(double behind, double more = 0, double offset = 0) {
  static ScanSeries series;
  series = {};
  test::TiltingScene scene(kNoiseOfPasses);
  constexpr int kSteps = 500;
  for (int i = 0; i < 2 * kSteps; ++i) {
    const bool up = i <= kSteps;
    const int at = up ? i : 2 * kSteps - i;
    const double read = 30 * kDegree + at * kStep;
    const double tilt = read - (up ? 0 : behind + more * at / kSteps);
    const double time = 0.1 * i;
    series.add(test::reading_at(read, time));
    auto scan = scene.scan(tilt, 20 * kDegree, 140, static_cast<std::uint16_t>(i), time);
    for (float& r : scan->echoes[0].ranges) r += up ? 0.0F : static_cast<float>(offset);
    series.add(std::move(scan));
  }
  return find_passes(series, series.actuator({.counts_per_revolution = 360000}), 5 * kDegree);
}

TEST(Passes, AreSplitWhereTheActuatorReverses) {
  const auto passes = up_and_down(0);
  ASSERT_EQ(passes.size(), 2U);
  EXPECT_TRUE(passes[0].up);
  EXPECT_FALSE(passes[1].up);
  EXPECT_EQ(passes[0].scans.size(), 501U);
  EXPECT_LT(passes[1].scans.front().angle, passes[1].scans.back().angle) << "sorted by angle";
}

TEST(PassOffset, IsEstimatedBetweenStepsInLargeNoise) {
  const auto passes = up_and_down(0.6 * kStep);
  const auto found = find_shift(passes[0], passes[1], 1);
  EXPECT_NEAR(found.shift, -0.6 * kStep, 3 * found.std_error);
  EXPECT_LT(found.std_error, 0.1 * kStep);
  EXPECT_NEAR(found.recovery_slope, 1, 0.1) << "injected shifts are recovered";
  EXPECT_GT(found.constant_p, 0.01);
}

TEST(PassOffset, RecoversInjectedFractionsOfAStep) {
  const auto passes = up_and_down(0);
  for (const auto& [injected, recovered] : find_shift(passes[0], passes[1], 1).recovered_shifts) {
    EXPECT_NEAR(recovered, injected, 0.05 * kStep) << "of " << injected / kStep << " steps";
  }
}

TEST(PassOffset, HasTheGainOfHeldOutAngles) {
  const auto passes = up_and_down(2 * kStep);
  const auto found = find_shift(passes[0], passes[1], 1);
  EXPECT_NEAR(found.shift, -2 * kStep, 3 * found.std_error);
  EXPECT_GT(found.constant_p, 0.01);
  EXPECT_LT(found.gain.ci95[1], 0);
  EXPECT_NEAR(found.gain.after, std::sqrt(2.0) * kNoiseOfPasses, 0.1 * kNoiseOfPasses)
      << "the residual is the noise of both passes";
}

TEST(PassOffset, IsZeroWithoutHysteresis) {
  const auto passes = up_and_down(0);
  const auto found = find_shift(passes[0], passes[1], 1);
  EXPECT_NEAR(found.shift, 0, 3 * found.std_error);
}

TEST(PassOffset, IgnoresARangeOffsetBetweenThePasses) {
  const auto passes = up_and_down(0, 0, 0.01);
  const auto found = find_shift(passes[0], passes[1], 1);
  EXPECT_NEAR(found.shift, 0, 3 * found.std_error);
  EXPECT_NEAR(found.offset, 0.01, 0.002);
}

TEST(PassOffset, IsPrintedAsUnknownIfNotFinite) {
  const double unknown = std::nan("");
  PassOffset found{.shift = unknown, .std_error = unknown, .offset = unknown};
  found.by_angle = found.by_beam = found.recovered_shifts = {{unknown, unknown}};
  found.recovered_shifts = {{0.001, unknown}};
  found.gain = {.metric = "", .unit = "m", .before = unknown, .after = unknown, .ci95 = {unknown, unknown}};
  found.recovery_slope = unknown;
  const std::string words = in_words("urg", found, kStep, 100);
  EXPECT_THAT(words, testing::Not(testing::HasSubstr("nan")));
  EXPECT_THAT(words, testing::HasSubstr("shifted by unknown ± unknown deg"));
  EXPECT_THAT(words, testing::HasSubstr("+0.0573: unknown"));
}

TEST(PassOffset, ReportsInhomogeneity) {
  const auto passes = up_and_down(0, 3 * kStep);
  EXPECT_LT(find_shift(passes[0], passes[1], 1).constant_p, 1e-3);
}

}  // namespace
}  // namespace crisp
