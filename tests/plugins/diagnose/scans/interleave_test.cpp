// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/diagnose/scans/interleave.hpp"

#include <gmock/gmock.h>

#include "tests/plugins/diagnose/scans/tilting_scene.hpp"

namespace crisp {
namespace {

using namespace crisp::data;
using namespace crisp::diagnose;

constexpr double kNoiseAtRest = 0.01;
constexpr std::uint16_t kScans = 120;

struct Odd {
  double shift = 0;   ///< [beams] excess direction of every other scan
  double offset = 0;  ///< [m] excess range of every other scan
};

std::vector<SeriesScan> stationary(const Odd& odd) {
  test::TiltingScene scene(kNoiseAtRest);
  ScanSeries series;
  for (std::uint16_t i = 0; i < kScans; ++i) {
    const bool other = i % 2 == 1;
    // The reference class is the one with more beams.
    auto scan =
        scene.scan(70 * kDegree, (20 + (other ? odd.shift : 0)) * kDegree, other ? 140 : 141, i, 0.0133 * i);
    for (float& r : scan->echoes[0].ranges) r += other ? static_cast<float>(odd.offset) : 0.0F;
    series.add(std::move(scan));
  }
  return series.scans();
}

TEST(Interleave, IsNotFoundInIdenticalScans) {
  const auto found = find_interleave(stationary({}), 1);
  EXPECT_EQ(found.period, 1U);
  ASSERT_EQ(found.difference.size(), 8U);
  // Mean absolute difference of two normal values.
  for (const double d : found.difference)
    EXPECT_NEAR(d, 2 * kNoiseAtRest / std::sqrt(std::numbers::pi), 3e-4);
}

TEST(Interleave, EstimatesTheShiftOfAScanClass) {
  const auto scans = stationary({.shift = 0.5});
  const auto found = find_interleave(scans, 1);
  EXPECT_EQ(found.period, 2U);
  EXPECT_LE(found.p_value, 0.01);
  const auto kinds = compare_classes(scans, 2, 1);
  ASSERT_EQ(kinds.size(), 1U);
  EXPECT_EQ(kinds[0].kind, 1U);
  EXPECT_NEAR(kinds[0].shift, 0.5, 3 * kinds[0].shift_error + 0.005);
  EXPECT_LT(kinds[0].shift_error, 0.05);
  EXPECT_GT(kinds[0].log10_bayes_factor, 5);
  EXPECT_LT(kinds[0].gain.ci95[1], 0) << "it generalizes to held-out scans";
  EXPECT_NEAR(kinds[0].recovered, kinds[0].injected, 0.1 * kinds[0].injected);
}

TEST(Interleave, IsFoundOverStationaryPhasesAtDifferentAngles) {
  test::TiltingScene scene(kNoiseAtRest);
  ScanSeries series;
  for (std::uint16_t rest = 0; rest < 6; ++rest) {
    for (std::uint16_t i = 0; i < 25; ++i) {
      const auto number = static_cast<std::uint16_t>(100 * rest + i);
      const double first = (20 + (number % 2 == 1 ? 0.5 : 0.0)) * kDegree;
      series.add(scene.scan((50 + 5 * rest) * kDegree, first, 140, number, 0.0133 * number));
    }
  }
  const auto found = find_interleave(series.scans(), 1);
  EXPECT_EQ(found.period, 2U);
  EXPECT_LE(found.p_value, 0.01);
}

TEST(Interleave, DistinguishesARangeOffsetFromAShift) {
  const auto scans = stationary({.offset = 0.02});
  EXPECT_EQ(find_interleave(scans, 1).period, 2U);
  const auto kinds = compare_classes(scans, 2, 1);
  ASSERT_EQ(kinds.size(), 1U);
  EXPECT_STREQ(kinds[0].next_likely, "range.offset");
  EXPECT_LT(kinds[0].log10_bayes_factor, 0);
}

TEST(Interleave, KeepsClassesAcrossAMissingScan) {
  auto scans = stationary({.shift = 0.5});
  scans.erase(scans.begin() + 31);
  scans.erase(scans.begin() + 50);
  EXPECT_EQ(find_interleave(scans, 1).period, 2U);
  EXPECT_NEAR(compare_classes(scans, 2, 1).at(0).shift, 0.5, 0.1);
}

}  // namespace
}  // namespace crisp
