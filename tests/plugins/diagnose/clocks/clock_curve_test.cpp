// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/diagnose/clocks/clock_curve.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace crisp {
namespace {

using namespace crisp::diagnose;

/// Minimum delays of a clock that runs ahead by `bend` seconds in the middle of a minute.
clocks::Envelope delays(double bend, std::uint64_t seed) {
  constexpr Eigen::Index kStretches = 64;
  constexpr double kScatter = 5e-6;  // [s]
  std::mt19937_64 random(seed);
  std::normal_distribution<double> noise(0, kScatter);
  clocks::Envelope envelope;
  envelope.time = Eigen::VectorXd::LinSpaced(kStretches, 0, 60);
  const Eigen::VectorXd about = (envelope.time.array() / 30 - 1).matrix();
  envelope.lead = Eigen::VectorXd::NullaryExpr(
      kStretches, [&](Eigen::Index k) { return bend * (1 - about[k] * about[k]) + noise(random); });
  return envelope;
}

TEST(ClockCurve, HasNoMoreBendsThanTheClock) {
  int needless = 0;
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    const auto curve = smooth_curve(delays(2e-3, seed), seed);
    ASSERT_TRUE(curve) << seed;
    needless += curve->parameters > 1 ? 1 : 0;
    EXPECT_LT(curve->parameters, 5) << seed;
    // The RMS of 1 − x² about its mean over −1 to 1; a few per cent more in 64 stretches.
    EXPECT_NEAR(curve->size, 2e-3 * std::sqrt(4.0 / 45), 30e-6) << seed;
  }
  EXPECT_LT(needless, 8) << "BIC takes a needless one with a probability of 4 %, of ten that it may take";
}

}  // namespace
}  // namespace crisp
