// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/estimate/measurement_buffer.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include <crisp/error.hpp>

namespace crisp {
namespace {

using namespace crisp::estimate;

std::shared_ptr<const PlateTrajectory> plate() {
  return std::make_shared<const PlateTrajectory>(7, std::vector<double>{0, 1, 2},
                                                 std::vector<double>{0, 1, 2}, 1.5);
}

std::shared_ptr<const Measurements> scan(std::uint16_t laser, std::size_t beams) {
  auto scan = std::make_shared<Measurements>();
  scan->epoch_ns = 7;
  scan->range.assign(beams, 1);
  scan->mirror_angle.assign(beams, 0);
  scan->time.assign(beams, 0.5);
  scan->laser.assign(beams, laser);
  scan->remission.assign(beams, 0);
  scan->beam.assign(beams, 0);
  return scan;
}

TEST(MeasurementBuffer, KeepsAllThatItMay) {
  MeasurementBuffer collected;
  const auto trajectory = plate();
  for (int i = 0; i < 10; ++i) collected.add(scan(1, 5), trajectory);
  const Sample sample = collected.sample();
  EXPECT_EQ(sample.beams.size(), 50U);
  EXPECT_EQ(sample.beams.epoch_ns, 7);
  EXPECT_EQ(sample.plate->size(), 3U);
  EXPECT_EQ(collected.left_out(), 0U);
}

TEST(MeasurementBuffer, KeepsEvenlyManyOfLasersThatTakeTurns) {
  MeasurementBuffer collected(1000);
  const auto trajectory = plate();
  for (int i = 0; i < 4000; ++i) collected.add(scan(static_cast<std::uint16_t>(i % 2), 1), trajectory);
  const Sample sample = collected.sample();
  EXPECT_LE(sample.beams.size(), 1000U);
  EXPECT_GT(sample.beams.size(), 400U);
  EXPECT_EQ(sample.beams.size() + collected.left_out(), 4000U);
  const auto first = std::count(sample.beams.laser.begin(), sample.beams.laser.end(), 0);
  EXPECT_NEAR(static_cast<double>(first), static_cast<double>(sample.beams.size()) / 2, 5);
}

TEST(MeasurementBuffer, OfNothingIsAnError) {
  MeasurementBuffer collected;
  EXPECT_THROW(collected.sample(), Error);
}

}  // namespace
}  // namespace crisp
