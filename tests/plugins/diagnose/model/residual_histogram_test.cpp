// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/diagnose/model/residual_histogram.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <random>

namespace crisp {
namespace {

using namespace crisp::diagnose;

/// Residuals of two interleaved lasers; the second has twice the assumed noise of the first.
struct TwoLasers {
  Residuals residuals;
  Measurements beams;
  std::vector<double> noise;

  explicit TwoLasers(std::uint32_t n) {
    for (std::uint32_t k = 0; k < n; ++k) {
      residuals.beam.push_back(k);
      residuals.reported.push_back(k % 2 == 0 ? 0.01 : 0.02);
      beams.laser.push_back(static_cast<std::uint16_t>(k % 2));
    }
    noise.assign(n, 0.5);
  }
  WeightedResiduals drawn(std::uint64_t seed, double times) const {
    std::mt19937_64 random(seed);
    std::normal_distribution<> normal;
    WeightedResiduals made;
    for (const double reported : residuals.reported) {
      made.value.push_back(times * 0.5 * reported * normal(random));
      made.weight.push_back(1);
    }
    return made;
  }
  std::vector<NoiseCounts> counts(const WeightedResiduals& values) const {
    return counts_of(values, residuals, noise, beams);
  }
};

TEST(ResidualDistribution, OfNormalNoiseIsStandardNormal) {
  const TwoLasers some(100'000);
  const auto all = distributions(some.counts(some.drawn(1, 1)), {some.counts(some.drawn(2, 1))});
  ASSERT_EQ(all.size(), 2U);
  for (const Distribution& one : all) {
    EXPECT_NEAR(one.measured_rms, 1, 0.015) << "standard error 0.003 for 50 000 residuals";
    const auto middle = std::ranges::find_if(one.bins, [](const auto& bin) { return bin.at > 0; });
    EXPECT_NEAR(middle->at, 0.125, 1e-12);
    EXPECT_NEAR(middle->measured, 0.3958, 4 * middle->error) << "exp(-0.125^2 / 2) / sqrt(2 pi)";
    EXPECT_NEAR(middle->simulated, 0.3958, 4 * middle->error);
    EXPECT_NEAR(one.single, 1 / (50'000 * 0.25), 1e-12);
    EXPECT_NEAR(middle->error, std::sqrt(0.3958 / (50'000 * 0.25)), 0.0002) << "Poisson statistics";
  }
}

TEST(ResidualDistribution, IsWiderThanSimulatedForLargerErrors) {
  const TwoLasers some(20'000);
  const auto all = distributions(some.counts(some.drawn(1, 1.5)),
                                 {some.counts(some.drawn(2, 1)), some.counts(some.drawn(3, 1))});
  EXPECT_NEAR(all.at(1).measured_rms, 1.5, 0.04);
  EXPECT_NEAR(all.at(1).simulated_rms, 1, 0.02);
  double measured = 0, simulated = 0;
  for (const auto& bin : all[1].bins) {
    measured += 0.25 * bin.measured;
    simulated += 0.25 * bin.simulated;
  }
  EXPECT_NEAR(measured, 1, 0.001) << "one in 16 000 exceeds 4 sigma";
  EXPECT_NEAR(simulated, 1, 1e-9);
}

TEST(ResidualDistribution, LeavesOutZeroWeightsAndLasersWithoutResiduals) {
  const TwoLasers some(1000);
  WeightedResiduals values = some.drawn(1, 1);
  for (std::size_t k = 0; k < values.weight.size(); k += 2) values.weight[k] = 0;
  const auto all = distributions(some.counts(values), {some.counts(values)});
  ASSERT_EQ(all.size(), 1U);
  EXPECT_EQ(all[0].laser, 1U);
  EXPECT_TRUE(distributions({}, {}).empty());
}

}  // namespace
}  // namespace crisp
