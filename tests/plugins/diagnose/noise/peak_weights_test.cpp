// SPDX-License-Identifier: BSD-3-Clause
// The limits of the two peaks' weights are estimated without bias and with honest errors.
#include "plugins/diagnose/noise/peak_weights.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace crisp {
namespace {

using namespace crisp::diagnose;

struct Drawn {
  double least = 0.1, most = 0.9;  // limits of the weights
  int beams = 200, scans = 150;
  double separation = 0.015, sigma = 0.005;  // [m]
};

/// Ranges about the means of their beams, rounded like a telegram's.
RangeErrors errors_of(const Drawn& drawn, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<> normal(0, drawn.sigma);
  RangeErrors errors;
  for (int beam = 0; beam < drawn.beams; ++beam) {
    const double range = std::uniform_real_distribution<>(1, 10)(random);
    std::bernoulli_distribution far(std::uniform_real_distribution<>(drawn.least, drawn.most)(random));
    for (int scan = 0; scan < drawn.scans; ++scan) {
      const double measured = range + normal(random) + (far(random) ? drawn.separation : 0);
      errors.value.push_back(static_cast<float>(1e-3 * std::round(1e3 * measured)));
      errors.range.push_back(static_cast<float>(range));
      errors.beam.push_back(static_cast<std::uint16_t>(beam));
      errors.block.push_back(static_cast<std::uint32_t>(scan));
    }
  }
  errors.centre_beams();
  return errors;
}

WeightLimits limits_of(const Drawn& drawn, std::uint64_t seed) {
  const RangeErrors errors = errors_of(drawn, seed);
  NoiseModel model{.size = {drawn.sigma, 0, 0, 0}, .separation = drawn.separation};
  model.weight.assign(static_cast<std::size_t>(drawn.beams), 0.5);
  return weight_limits(fitted(model, errors), errors);
}

/// Errors of the estimates of one limit in units of their standard errors.
struct Offs {
  int all = 0, within_three = 0;
  double sum = 0, squares = 0, errors = 0;

  void add(double value, double truth, double error) {
    const double off = (value - truth) / error;
    ++all;
    within_three += std::abs(off) < 3 ? 1 : 0;
    sum += off;
    squares += off * off;
    errors += error;
  }
};

/// Standard error 1/√n of the mean of standard normal values, √(2/n) of their mean square.
void expect_honest(const Offs& offs, const char* limit) {
  EXPECT_LT(std::abs(offs.sum / offs.all), 3 / std::sqrt(offs.all)) << limit << ": no bias";
  EXPECT_GE(offs.within_three, 0.97 * offs.all) << limit;
  EXPECT_NEAR(offs.squares / offs.all, 1, 4 * std::sqrt(2.0 / offs.all)) << limit;
}

void expect_honest_limits(const Drawn& drawn, int seeds, double most_error) {
  Offs least;
  Offs most;
  for (int seed = 1; seed <= seeds; ++seed) {
    const WeightLimits found = limits_of(drawn, static_cast<std::uint64_t>(seed));
    least.add(found.least, drawn.least, found.least_error);
    most.add(found.most, drawn.most, found.most_error);
  }
  expect_honest(least, "least");
  expect_honest(most, "most");
  EXPECT_LT(least.errors / seeds, most_error) << "it is informative";
}

TEST(PeakWeights, HaveUnbiasedLimits) { expect_honest_limits({}, 16, 0.015); }

TEST(PeakWeights, HaveUnbiasedNarrowLimitsFromUncertainWeights) {
  expect_honest_limits({.least = 0.35, .most = 0.6}, 16, 0.015);
}

TEST(PeakWeights, StayWithinTheLimitsOfShares) {
  const WeightLimits found = limits_of({.least = 0, .most = 1}, 1);
  EXPECT_GE(found.least, 0);
  EXPECT_LE(found.most, 1);
  EXPECT_NEAR(found.least, 0, 3 * found.least_error);
  EXPECT_NEAR(found.most, 1, 3 * found.most_error);
}

}  // namespace
}  // namespace crisp
