// SPDX-License-Identifier: BSD-3-Clause
// Dependence of noise on a covariate is detected where it is, and only there.
#include <gmock/gmock.h>

#include <cmath>
#include <functional>
#include <random>

#include "plugins/diagnose/noise/surface_range_errors.hpp"

namespace crisp {
namespace {

using namespace crisp::diagnose;

/// Normal errors, each with its own σ.
RangeErrors errors_of(std::uint64_t seed, std::size_t n, const std::function<double(std::size_t)>& sigma) {
  std::mt19937_64 random(seed);
  std::normal_distribution<> normal;
  RangeErrors errors;
  for (std::size_t i = 0; i < n; ++i) {
    errors.value.push_back(static_cast<float>(sigma(i) * normal(random)));
    errors.range.push_back(3);
    errors.beam.push_back(0);
    errors.block.push_back(static_cast<std::uint32_t>(i / 100));
  }
  return errors;
}

TEST(NoiseBy, DetectsDependenceOnlyWhereItIs) {
  constexpr std::size_t kRanges = 20'000;
  std::vector<float> cosine;
  for (std::size_t i = 0; i < kRanges; ++i) cosine.push_back(0.5F + 0.5F * static_cast<float>(i % 97) / 97);
  NoiseModel model;
  model.size[0] = 0.012;
  int named = 0;
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    const auto plain = errors_of(seed, kRanges, [](std::size_t) { return 0.012; });
    named += noise_by("incidence", cosine, "laser1", plain, model, 0, seed) ? 1 : 0;
  }
  EXPECT_LE(named, 1) << "of 50, where 0.002 each are expected";
  const auto changing =
      errors_of(1, kRanges, [&](std::size_t i) { return cosine[i] < 0.6F ? 0.024 : 0.012; });
  const auto found = noise_by("incidence", cosine, "laser1", changing, model, 0.001, 1);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->covariate, "incidence");
  EXPECT_EQ(found->quantity, "noise");
  EXPECT_TRUE(found->accepted);
}

TEST(NoiseBy, TestsWhatTheNoiseModelLeaves) {
  constexpr std::size_t kRanges = 20'000;
  NoiseModel model;
  model.parts = {true, false, true, false};
  model.size = {0.012, 0, 0.009, 0};
  std::vector<float> cosine;
  for (std::size_t i = 0; i < kRanges; ++i) cosine.push_back(0.5F + 0.5F * static_cast<float>(i % 97) / 97);
  auto errors = errors_of(1, kRanges, [&](std::size_t i) {
    const double tangent = std::tan(std::acos(double{cosine[i]}));
    return std::hypot(0.012, 0.009 * tangent);
  });
  errors.cosine = cosine;
  EXPECT_FALSE(noise_by("incidence", cosine, "laser1", errors, model, 0.001, 1));
  EXPECT_TRUE(noise_by("incidence", cosine, "laser1", errors, {}, 0.001, 1)) << "a noise model without it";
}

}  // namespace
}  // namespace crisp
