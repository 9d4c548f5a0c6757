// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/data/encoder_smoothing.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <utility>

namespace crisp {
namespace {

using namespace crisp::data;

constexpr double kStep = 2 * std::numbers::pi / 16384;

struct Readings {
  std::vector<double> times;
  std::vector<double> truth;
  std::vector<double> angles;
};

/// 4 s at 500 Hz, by stamps whose errors have this standard deviation [s].
template <class Angle>
Readings read(Angle angle, double jitter = 0) {
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal;
  Readings readings;
  for (int i = 0; i < 2000; ++i) {
    readings.times.push_back(0.002 * i);
    readings.truth.push_back(angle(0.002 * i));
    readings.angles.push_back(kStep * std::round(angle(0.002 * i + jitter * normal(random)) / kStep));
  }
  return readings;
}

double rms(const std::vector<double>& angles, const std::vector<double>& truth) {
  double sum = 0;
  for (std::size_t i = 0; i < angles.size(); ++i) sum += std::pow(angles[i] - truth[i], 2);
  return std::sqrt(sum / static_cast<double>(angles.size()));
}

constexpr double kTurn = 2 * std::numbers::pi;
const double kRounding = kStep / std::sqrt(12.0);
constexpr double kWidth = 0.2;  // [s]

// Between 0 and 2 Hz.
double varying(double t) { return kTurn * (t - 0.3 * std::sin(3 * t)); }

TEST(EncoderSmoothing, TakesMostOfTheRoundingAway) {
  const auto readings = read(varying);
  EXPECT_NEAR(rms(readings.angles, readings.truth), kRounding, 0.1 * kRounding);
  const auto smooth = between_steps(readings.times, readings.angles, kStep, kWidth);
  // In the middle of a polynomial of the fourth degree through 101 points least squares has 1.9 / √101 = 0.19
  // of their noise.
  EXPECT_LT(rms(smooth, readings.truth), 0.12 * kRounding);
}

TEST(EncoderSmoothing, IsNoWorseThanTheReadingsWhereRoundingsOfNeighboursAreAlike) {
  for (const double rate : {1.0, 0.9999, 0.3052, 0.0}) {  // [Hz] the third: 10.0008 steps a reading
    const auto readings = read([&](double t) { return kTurn * rate * t + 0.3 * kStep; });
    const auto smooth = between_steps(readings.times, readings.angles, kStep, kWidth);
    EXPECT_LT(rms(smooth, readings.truth), rms(readings.angles, readings.truth) + 0.05 * kRounding) << rate;
  }
}

TEST(EncoderSmoothing, FollowsAPlateThatIsShakenAndPoorStamps) {
  const auto shaken = [](double t) { return kTurn * t + 5 * kStep * std::sin(60 * t); };
  const auto readings = read(shaken);
  EXPECT_LT(rms(between_steps(readings.times, readings.angles, kStep, kWidth), readings.truth),
            0.5 * kRounding);
  const auto poor = read(varying, 2e-5);  // 0.65 steps at 2 Hz
  EXPECT_LT(rms(between_steps(poor.times, poor.angles, kStep, kWidth), poor.truth),
            0.5 * rms(poor.angles, poor.truth));
}

TEST(EncoderSmoothing, GivesAPieceTheAnglesThatTheWholeHas) {
  const auto readings = read(varying);
  const auto whole = between_steps(readings.times, readings.angles, kStep, kWidth);
  constexpr std::ptrdiff_t kBegin = 700, kEnd = 1300;
  const auto piece =
      between_steps({readings.times.begin() + kBegin, readings.times.begin() + kEnd},
                    {readings.angles.begin() + kBegin, readings.angles.begin() + kEnd}, kStep, kWidth);
  for (std::ptrdiff_t i = 150; i < kEnd - kBegin - 150; ++i) {
    EXPECT_EQ(piece[static_cast<std::size_t>(i)], whole[static_cast<std::size_t>(kBegin + i)]);
  }
}

TEST(EncoderSmoothing, BridgesSilences) {
  auto readings = read(varying);
  for (const auto& [from, to] : {std::pair(1200, 1290), std::pair(500, 504)}) {
    for (auto* column : {&readings.times, &readings.truth, &readings.angles})
      column->erase(column->begin() + from, column->begin() + to);
  }
  const auto smooth = between_steps(readings.times, readings.angles, kStep, kWidth);
  EXPECT_LT(rms(smooth, readings.truth), 0.2 * kRounding);
}

TEST(EncoderSmoothing, IsExactOnAParabola) {
  std::vector<double> times;
  std::vector<double> angles;
  for (int i = 0; i < 100; ++i) {
    times.push_back(0.002 * i + (i % 3) * 1e-4);
    angles.push_back(1 + 3 * times.back() - 7 * times.back() * times.back());
  }
  const auto smooth = between_steps(times, angles, kStep, kWidth);
  for (std::size_t i = 0; i < times.size(); ++i) EXPECT_NEAR(smooth[i], angles[i], 1e-12);
}

TEST(EncoderSmoothing, MovesNoAngleByMoreThanRoundingCouldHave) {
  // A plate that is hit 40 times a second, ten steps far.
  const auto readings = read([](double t) { return 5 * t + 10 * kStep * std::sin(250 * t); });
  const auto smooth = between_steps(readings.times, readings.angles, kStep, kWidth);
  for (std::size_t i = 0; i < smooth.size(); ++i) {
    EXPECT_LE(std::abs(smooth[i] - readings.angles[i]), 0.6 * kStep + 1e-12);
  }
}

TEST(EncoderSmoothing, LeavesAloneWhatHasNoNeighboursOrIsNotRequested) {
  const std::vector<double> times{0, 1, 2, 3, 4, 5, 6, 7, 8};
  const std::vector<double> angles{0, 1, 0, 1, 0, 1, 0, 1, 0};
  EXPECT_EQ(between_steps(times, angles, 1, kWidth), angles);
  EXPECT_EQ(between_steps(times, angles, 1, 0), angles);
  EXPECT_TRUE(between_steps({}, {}, 1, kWidth).empty());
}

}  // namespace
}  // namespace crisp
