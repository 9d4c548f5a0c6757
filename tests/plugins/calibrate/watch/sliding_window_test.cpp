// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/calibrate/watch/sliding_window.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/plugins/calibrate/watch/support.hpp"

namespace crisp {
namespace {

using namespace crisp::calibrate;
using namespace crisp::estimate;

TEST(SlidingWindow, KeepsTheLastSecondsAndNoMore) {
  SlidingWindow recent(0.5);
  for (auto& batch : test::batches_of(test::recorded(1.5))) recent.add(std::move(batch));
  EXPECT_GT(recent.duration(), 0.45);
  EXPECT_LT(recent.duration(), 0.6);
}

TEST(SlidingWindow, TakesAShareOfAllBatches) {
  const auto batches = test::batches_of(test::recorded(0.5));
  constexpr std::size_t kMax = 5000;
  PlateTrajectory plate;
  const Sample sample = sample_of(batches, kMax, plate);
  // Each batch is sampled: sqrt(5000) = 71 is one standard deviation at most.
  EXPECT_NEAR(static_cast<double>(sample.beams.size()), kMax, 5 * 71);
  EXPECT_LT(sample.beams.time.front(), batches.front().beams->time.back());
  EXPECT_GT(sample.beams.time.back(), batches.back().beams->time.front());
}

TEST(SlidingWindow, JoinsPiecesOfAClockThatIsBetterKnownEachTimeWithoutAJerk) {
  // A plate at 1 Hz, read 500 times a second; each piece overlaps the one before, and is 20 us off it.
  const double turn = 2 * M_PI;
  std::vector<SlidingWindow::Batch> batches;
  for (int k = 0; k < 20; ++k) {
    std::vector<double> times, angles;
    for (int i = 0; i < 70; ++i) {
      const double t = 0.02 * k + 0.002 * i;
      times.push_back(t + (k % 2 == 0 ? 20e-6 : 0));
      angles.push_back(turn * t);
    }
    Measurements beams;
    beams.range = {1};
    beams.mirror_angle = {0};
    beams.time = {0.02 * k + 0.05};
    beams.laser = {0};
    beams.remission = {0};
    beams.beam = {0};
    batches.push_back({std::make_shared<const Measurements>(beams),
                       std::make_shared<const PlateTrajectory>(0, times, angles, 0.1)});
  }
  PlateTrajectory plate;
  const Sample sample = sample_of(batches, 1000, plate);
  EXPECT_EQ(sample.beams.size(), 20U);
  for (double t = 0.01; t < 0.45; t += 1e-4) {
    const auto state = plate.at(t);
    ASSERT_TRUE(state) << t;
    EXPECT_NEAR(state->angle, turn * t, turn * 30e-6);
    // Two neighbours that are off by 20 us the contrary way are off by 2 % of their 2 ms.
    EXPECT_NEAR(state->rate, turn, 0.05 * turn) << t;
  }
}

}  // namespace
}  // namespace crisp
