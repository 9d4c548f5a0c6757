// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/data/encoder_smoothing.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace crisp {
namespace {

constexpr double kStep = 2 * std::numbers::pi / 16384;

struct Readings {
  std::vector<double> times;
  std::vector<double> truth;
  std::vector<double> angles;
};

/// 4 s at 500 Hz.
template <class Angle>
Readings read(Angle angle) {
  Readings readings;
  for (int i = 0; i < 2000; ++i) {
    readings.times.push_back(0.002 * i);
    readings.truth.push_back(angle(0.002 * i));
    readings.angles.push_back(kStep * std::round(readings.truth.back() / kStep));
  }
  return readings;
}

double rms(const std::vector<double>& angles, const std::vector<double>& truth) {
  double sum = 0;
  for (std::size_t i = 0; i < angles.size(); ++i) sum += std::pow(angles[i] - truth[i], 2);
  return std::sqrt(sum / static_cast<double>(angles.size()));
}

TEST(EncoderSmoothing, TakesMostOfTheRoundingAway) {
  // A plate between 0 and 2 Hz.
  const auto readings = read([](double t) { return 2 * std::numbers::pi * (t - 0.3 * std::sin(3 * t)); });
  const double rounding = kStep / std::sqrt(12.0);
  EXPECT_NEAR(rms(readings.angles, readings.truth), rounding, 0.1 * rounding);
  const auto smooth = between_steps(readings.times, readings.angles, kStep, 0.05);
  // The value in the middle of a parabola through 51 points has 1.5 / √51 = 0.21 of their noise; where the
  // rate stands still for a moment, roundings of neighbours are alike.
  EXPECT_LT(rms(smooth, readings.truth), 0.35 * rounding);
}

TEST(EncoderSmoothing, IsExactOnAParabola) {
  std::vector<double> times;
  std::vector<double> angles;
  for (int i = 0; i < 100; ++i) {
    times.push_back(0.002 * i + (i % 3) * 1e-4);
    angles.push_back(1 + 3 * times.back() - 7 * times.back() * times.back());
  }
  const auto smooth = between_steps(times, angles, kStep, 0.05);
  for (std::size_t i = 0; i < times.size(); ++i) EXPECT_NEAR(smooth[i], angles[i], 1e-12);
}

TEST(EncoderSmoothing, MovesNoAngleByMoreThanRoundingCouldHave) {
  // A plate that is hit 40 times a second, ten steps far.
  const auto readings = read([](double t) { return 5 * t + 10 * kStep * std::sin(250 * t); });
  const auto smooth = between_steps(readings.times, readings.angles, kStep, 0.05);
  for (std::size_t i = 0; i < smooth.size(); ++i) {
    EXPECT_LE(std::abs(smooth[i] - readings.angles[i]), 0.6 * kStep + 1e-12);
  }
}

TEST(EncoderSmoothing, LeavesAloneWhatHasNoNeighboursOrIsNotAskedFor) {
  const std::vector<double> times{0, 1, 2, 3, 4, 5, 6, 7, 8};
  const std::vector<double> angles{0, 1, 0, 1, 0, 1, 0, 1, 0};
  EXPECT_EQ(between_steps(times, angles, 1, 0.05), angles);
  EXPECT_EQ(between_steps(times, angles, 1, 0), angles);
  EXPECT_TRUE(between_steps({}, {}, 1, 0.05).empty());
}

}  // namespace
}  // namespace crisp
