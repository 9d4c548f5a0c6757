// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/estimate/encoder_error_blocks.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tests/pipeline/estimate/support.hpp"

namespace crisp {
namespace {

using namespace crisp::estimate;
using namespace crisp::simulate;

/// Mean square of the mean rounding error [steps²] of readings at these angles [steps], by trying many places
/// between two steps for the first.
double mean_square_by_trial(const std::vector<double>& angles) {
  constexpr int kTrials = 200000;
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> place(0, 1);
  double sum = 0;
  for (int trial = 0; trial < kTrials; ++trial) {
    const double from = place(random);
    double error = 0;
    for (const double angle : angles) error += std::round(from + angle) - (from + angle);
    sum += std::pow(error / static_cast<double>(angles.size()), 2);
  }
  return sum / kTrials;
}

TEST(VarianceOfMeanReading, IsThatOfRounding) {
  constexpr double kStep = 0.0004;
  // Stationary; by three tenths of a step; by very nearly whole steps; faster and faster.
  std::vector<std::vector<double>> motions(4);
  for (int i = 0; i < 25; ++i) {
    motions[0].push_back(0);
    motions[1].push_back(0.3 * i);
    motions[2].push_back(7.01 * i);
    motions[3].push_back(2.1 * i + 0.013 * i * i);
  }
  for (const auto& steps : motions) {
    std::vector<double> angles;
    for (const double step : steps) angles.push_back(step * kStep);
    const double truth = mean_square_by_trial(steps);
    // 200 000 trials know a mean square of what is nearly normal to 0.3 %.
    EXPECT_NEAR(variance_of_mean_reading(angles, kStep) / (kStep * kStep * truth), 1, 0.015);
  }
  const std::vector<double> at_rest(25, 1.0);
  EXPECT_NEAR(variance_of_mean_reading(at_rest, kStep), kStep * kStep / 12, 1e-12 * kStep);
}

TEST(EncoderErrorBlocks, GoByThePlatesClock) {
  const auto recording = simulate_measurements(misplaced_scanner(1, 1.0), office());
  const Sample sample{.beams = recording.beams, .plate = &recording.plate};
  const SensorModel model(recording.truth);
  const auto moments = encoder_error_blocks(model, sample, 0.0004);
  ASSERT_EQ(moments.of_beam.size(), recording.beams.size());
  double first = 1e9;
  const auto plate_time = [&](std::size_t i) {
    return recording.beams.time[i] + recording.truth.lasers[recording.beams.laser[i]].eta.value;
  };
  for (std::size_t i = 0; i < recording.beams.size(); ++i) first = std::min(first, plate_time(i));
  for (std::size_t i = 0; i < recording.beams.size(); i += 1009) {
    ASSERT_LT(moments.of_beam[i], moments.variances.size());
    EXPECT_NEAR(plate_time(i) - first, 0.05 * (moments.of_beam[i] + 0.5), 0.02501);
  }
  for (const double variance : moments.variances) {
    EXPECT_GT(variance, 0);
    EXPECT_LE(variance, 0.0004 * 0.0004 / 12 * (1 + 1e-9));
  }
}

}  // namespace
}  // namespace crisp
