// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/clocks/delay_step.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/simulated_stamps.hpp"

namespace crisp {
namespace {

using namespace crisp::clocks;
using test::Delays;

/// Stamps of 10 s at 50 Hz of a clock 80 ppm fast, of which those from `at` [s] on are later by `by` [s].
std::vector<Stamp> stamps_with_step(std::uint64_t seed, double at, double by, const Delays& delays) {
  auto stamps = test::simulated_stamps(seed, 10, 50, 80e-6, delays);
  for (Stamp& s : stamps) s.lead += s.device >= at ? by : 0;
  return stamps;
}

TEST(DelayStep, IsFoundWithItsSizeWithinItsError) {
  double squares = 0;
  int n = 0;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    const double at = 0.7 + 0.14 * static_cast<double>(seed);
    const double by = (seed % 2 == 0 ? 1 : -1) * (0.4e-3 + 0.1e-3 * static_cast<double>(seed));
    const auto stamps = stamps_with_step(seed, at, by, test::exponential_delays(1e-4));
    const auto step = step_of_delay(stamps);
    ASSERT_TRUE(step) << seed;
    EXPECT_NEAR(step->by, by, 5 * step->std_error) << seed;
    EXPECT_LE(stamps[step->from].device, at) << seed;
    EXPECT_GE(stamps[step->to].device, at) << seed;
    EXPECT_NEAR(stamps[step->first].device, at, 0.1) << seed;
    squares += std::pow((step->by - by) / step->std_error, 2);
    ++n;
  }
  // Least delays are exponential: 60 squares about 1 have a mean within 1 ± 0.4.
  EXPECT_GT(squares / n, 0.3);
  EXPECT_LT(squares / n, 1.5);
}

TEST(DelayStep, IsNotSeenInDelaysWithoutOne) {
  const Delays distributions[] = {test::exponential_delays(1e-4), test::exponential_delays(3e-3),
                                  test::gamma_delays(4, 1e-3), test::bursty_delays(1e-4, 3e-3, 20, 0.01),
                                  test::bursty_delays(1e-4, 2e-3, 60, 0.005)};
  for (const Delays& law : distributions) {
    int found = 0;
    for (std::uint64_t seed = 1; seed <= 200; ++seed) {
      const auto stamps = stamps_with_step(seed, 99, 0, law);
      const auto step = step_of_delay(stamps);
      // A burst that lasts to an end of the recording is indistinguishable from a step.
      constexpr std::size_t kBurst = 90;
      if (step && step->to > kBurst && step->from + kBurst < stamps.size()) ++found;
    }
    EXPECT_EQ(found, 0);
  }
}

TEST(DelayStep, IsNotSeenInAClockThatDrifts) {
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    auto stamps = stamps_with_step(seed, 99, 0, test::exponential_delays(1e-4));
    for (Stamp& s : stamps) s.lead += 0.5 * 50e-6 * s.device * s.device;  // 2.5 ms over the time
    EXPECT_FALSE(step_of_delay(stamps)) << seed;
  }
}

TEST(DelayStep, NeedsStampsEnough) {
  const auto stamps = stamps_with_step(1, 1, 5e-3, test::exponential_delays(1e-4));
  EXPECT_FALSE(step_of_delay(std::span(stamps).first(90)));
}

}  // namespace
}  // namespace crisp
