// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/estimate/cross_validation.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/pipeline/estimate/support.hpp"

namespace crisp {
namespace {

using namespace crisp::data;
using namespace crisp::estimate;
using namespace crisp::simulate;

constexpr double kMostOfGood = 1.6;  // 11 parameters: 1 ± 0.2, less where both halves share errors
constexpr auto kGoOn = [](int) { return true; };

/// Halves of a recording in the office whose encoder is off by `error` (of the plate's angle, [rad] → [rad]).
template <class Error>
std::optional<CrossValidation> halves_with(const Error& error, double duration) {
  const auto simulated = simulate_measurements(misplaced_scanner(4, duration), office());
  std::vector<double> angles;
  for (const double angle : simulated.plate.angles()) angles.push_back(angle + error(angle));
  const PlateTrajectory plate(simulated.plate.epoch_ns(),
                              {simulated.plate.times().begin(), simulated.plate.times().end()},
                              std::move(angles), simulated.plate.max_gap());
  return cross_validate(SensorModel(simulated.truth), {.beams = simulated.beams, .plate = &plate}, {}, kGoOn);
}

constexpr auto kNoError = [](double) { return 0.0; };

TEST(CrossValidation, HalvesOfAGoodRecordingAgreeWithinTheirStandardErrors) {
  const auto halves = halves_with(kNoError, 6);
  ASSERT_TRUE(halves);
  EXPECT_GT(halves->ratio(), 0.05);
  EXPECT_LT(halves->ratio(), kMostOfGood);
  EXPECT_LT(halves->difference, 2e-3);
}

TEST(CrossValidation, WhatReturnsEveryOtherTurnParts) {
  // A belt's tooth: the encoder goes round once while the plate turns twice.
  const auto halves = halves_with([](double angle) { return 1 * kDegree * std::sin(angle / 2); }, 6);
  ASSERT_TRUE(halves);
  EXPECT_GT(halves->ratio(), kMostOfGood) << halves->difference << " m, expected " << halves->expected;
}

TEST(CrossValidation, NeedsTwoTurns) { EXPECT_FALSE(halves_with(kNoError, 0.5)); }

}  // namespace
}  // namespace crisp
