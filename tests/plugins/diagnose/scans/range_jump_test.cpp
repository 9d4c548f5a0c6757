// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/diagnose/scans/range_jump.hpp"

#include <gtest/gtest.h>

#include "tests/plugins/diagnose/scans/tilting_scene.hpp"

namespace crisp {
namespace {

using namespace crisp::data;
using namespace crisp::diagnose;
using test::TiltingScene;

/// A sweep in which all ranges increase by `by` [m] at the eightieth scan.
std::vector<SeriesScan> sweep(double by, std::uint64_t seed) {
  TiltingScene scene(0.01, seed);
  ScanSeries series;
  for (std::uint16_t i = 0; i < 160; ++i) {
    auto scan = scene.scan((50 + 0.3 * i) * kDegree, 20 * kDegree, 140, i, TiltingScene::kPeriod * i);
    for (float& range : scan->echoes[0].ranges) range += static_cast<float>(i >= 80 ? by : 0);
    series.add(std::move(scan));
  }
  return series.scans();
}

TEST(RangeJump, IsNoSmallerThanAnActualJump) {
  for (const double by : {0.1, -0.1}) {
    const auto largest = largest_jump(sweep(by, 1));
    ASSERT_TRUE(largest);
    EXPECT_NEAR(*largest, 0.1, 0.015);
  }
}

TEST(RangeJump, IsBoundedByNoise) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const auto largest = largest_jump(sweep(0, seed));
    ASSERT_TRUE(largest);
    EXPECT_GT(*largest, 0.002);
    // Median of 140 beams of 10 mm noise, times √5 for the weights of four scans: 2.4 mm in the largest of
    // 157 scans, plus the wall's waves.
    EXPECT_LT(*largest, 0.025);
  }
}

TEST(RangeJump, NeedsFourScans) {
  auto few = sweep(0.03, 1);
  few.resize(3);
  EXPECT_FALSE(largest_jump(few));
  EXPECT_FALSE(largest_jump({}));
}

}  // namespace
}  // namespace crisp
