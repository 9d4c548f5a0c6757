// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/simulate/link.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include <crisp/error.hpp>

namespace crisp {
namespace {

using namespace crisp::simulate;

TEST(Link, DelaysByTheMinimumAndAnExponentialJitter) {
  Link link({.jitter = 1e-4, .stall_rate = 0, .seconds_per_byte = 0}, 2e-3, 1, "laser1");
  constexpr int kTelegrams = 20'000;
  double sum = 0;
  double least = 1;
  for (int i = 0; i < kTelegrams; ++i) {
    const double delay = link.arrival(0.02 * i, 2000) - 0.02 * i;
    sum += delay;
    least = std::min(least, delay);
  }
  EXPECT_GE(least, 2e-3);
  EXPECT_LT(least, 2e-3 + 1e-6) << "20 000 draws of mean 100 µs come within 5 ns on average";
  EXPECT_NEAR(sum / kTelegrams, 2.1e-3, 4 * 1e-4 / std::sqrt(kTelegrams));
}

TEST(Link, HasDelaysByWeibullsModel) {
  for (const double shape : {0.7, 1.6}) {
    Link link({.jitter = 1e-4, .shape = shape, .stall_rate = 0, .seconds_per_byte = 0}, 0, 1, "laser1");
    constexpr std::size_t kTelegrams = 20'000;
    std::vector<double> delays;
    double sum = 0;
    for (std::size_t i = 0; i < kTelegrams; ++i) {
      const double sent = static_cast<double>(i);
      delays.push_back(link.arrival(sent, 100) - sent);
      sum += delays.back();
    }
    std::ranges::sort(delays);
    const double ratio = delays[kTelegrams * 95 / 100] / delays[kTelegrams / 2];
    EXPECT_NEAR(std::log(ratio), std::log(std::log(20) / std::log(2)) / shape, 0.06) << shape;
    // A law of shape 0.7 scatters by 1.46 of its mean, one of 1.6 by 0.64.
    EXPECT_NEAR(sum / kTelegrams, 1e-4, 4 * 1.5e-4 / std::sqrt(kTelegrams)) << shape;
  }
}

TEST(Link, HandsOnBurstsAsRequested) {
  const BurstSettings bursts{.together = 0.56, .interval = 0.0133, .wait = 0.07};
  Link link(with_bursts({.jitter = 1e-6, .seconds_per_byte = 0}, bursts), 1e-3, 1, "laser1");
  constexpr int kTelegrams = 200'000;
  int together = 0;
  double sum = 0;
  double squares = 0;
  double last = -1;
  for (int i = 0; i < kTelegrams; ++i) {
    const double sent = bursts.interval * i;
    const double arrived = link.arrival(sent, 100);
    if (arrived - last < 1e-4) ++together;
    last = arrived;
    sum += arrived - sent;
    squares += (arrived - sent) * (arrived - sent);
  }
  // 24 000 stalls, of which waits of three in a thousand make half of the variance.
  EXPECT_NEAR(static_cast<double>(together) / kTelegrams, bursts.together, 0.01);
  EXPECT_NEAR(std::sqrt(squares / kTelegrams - std::pow(sum / kTelegrams, 2)), bursts.wait,
              0.03 * bursts.wait);
  EXPECT_THROW(with_bursts({}, {.together = 0.9, .interval = 0.02, .wait = 0.01}), Error);
  EXPECT_THROW(with_bursts({}, {.together = 0.5}), Error);
}

TEST(Link, TakesLongerFromItsStepOn) {
  Link link({.jitter = 0, .stall_rate = 0, .seconds_per_byte = 0}, 1e-3, 1, "laser1", {.at = 2, .by = 4e-3});
  EXPECT_NEAR(link.arrival(1.99, 100), 1.991, 1e-12);
  EXPECT_NEAR(link.arrival(2.01, 100), 2.015, 1e-12);
  EXPECT_THROW(Link({}, 1e-3, 1, "laser1", {.at = 2, .by = -2e-3}), Error)
      << "no telegram arrives before it is sent";
}

TEST(Link, KeepsTelegramsInOrderAndApartByTheirLength) {
  Link link({.jitter = 5e-3, .stall_rate = 1, .stall_time = 0.1, .seconds_per_byte = 1e-6}, 0, 1, "laser1");
  double last = -1;
  for (int i = 0; i < 5000; ++i) {
    const double arrived = link.arrival(0.002 * i, 100);
    ASSERT_GE(arrived, last + 100e-6 - 1e-12);
    last = arrived;
  }
}

TEST(Link, DeliversWhatWasSentDuringAStallInABurst) {
  Link link({.jitter = 0, .stall_rate = 0.5, .stall_time = 0.2, .seconds_per_byte = 0}, 1e-3, 3, "laser1");
  int late = 0;
  double last = -1;
  int in_burst = 0;
  for (int i = 0; i < 50'000; ++i) {
    const double sent = 0.002 * i;
    const double arrived = link.arrival(sent, 10);
    if (arrived - sent > 1.0001e-3) ++late;
    if (arrived == last) ++in_burst;
    last = arrived;
  }
  // 100 s with a stall every 2.2 s on average of 0.2 s: one in eleven is late, nearly all of these together.
  EXPECT_NEAR(late / 50'000.0, 1.0 / 11, 0.04);
  EXPECT_GT(in_burst, late * 9 / 10);
}

TEST(Link, RefusesNegativeDelays) {
  EXPECT_THROW(Link({}, -1, 1, "laser1"), Error);
  EXPECT_THROW(Link({.jitter = -1}, 0, 1, "laser1"), Error);
}

}  // namespace
}  // namespace crisp
