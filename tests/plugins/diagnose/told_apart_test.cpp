// SPDX-License-Identifier: BSD-3-Clause
// Measured ranges are told from simulated ones by as much as they differ, and not where they do not.
#include "plugins/diagnose/told_apart.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>

#include "plugins/diagnose/noise.hpp"
#include "plugins/diagnose/report.hpp"
#include "tests/support/kolmogorov.hpp"

namespace crisp {
namespace {

using Random = std::mt19937_64;
using Error = std::function<double(Random&, int beam, int scan)>;

constexpr int kBeams = 60;
constexpr int kScans = 50;

double standard(Random& random) { return std::normal_distribution<>()(random); }
double even(Random& random) { return std::uniform_real_distribution<>(0, 1)(random); }

/// Shots of beams at rest in whole steps, less the mean of their beam.
RangeErrors shots(std::uint64_t seed, const Error& error, double step = 1e-3, int scans = kScans) {
  Random random(seed);
  RangeErrors all;
  for (int beam = 0; beam < kBeams; ++beam) {
    const double range = 1 + 10 * even(random);
    double mean = 0;
    std::vector<double> values;
    for (int scan = 0; scan < scans; ++scan) {
      values.push_back(step * std::round((range + error(random, beam, scan)) / step));
      mean += values.back() / scans;
    }
    for (int scan = 0; scan < scans; ++scan) {
      all.value.push_back(static_cast<float>(values[static_cast<std::size_t>(scan)] - mean));
      all.range.push_back(static_cast<float>(mean));
      all.beam.push_back(static_cast<std::uint16_t>(beam));
      all.block.push_back(static_cast<std::uint32_t>(scan));
    }
  }
  return all;
}

double plain(Random& random, int, int) { return 4e-3 * standard(random); }

/// As those of an LMS111: each beam with a weight of its own.
double about_two_values(Random& random, int beam, int) {
  const double weight = 0.2 + 0.7 * beam / kBeams;
  return 5e-3 * standard(random) + (even(random) < weight ? 15e-3 : 0);
}

NoiseLaw with_two_peaks() {
  NoiseLaw law{.size = {6e-3, 0, 0, 0}};
  law.weight.assign(kBeams, 0.5);
  law.separation = 14e-3;
  return law;
}

/// Whether ranges of a law are told from it as often as chance has it.
void expect_even(const NoiseLaw& like, const Error& error) {
  constexpr int kSeeds = 16;
  std::vector<double> chances;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    chances.push_back(beside_law(shots(seed, error), like, {}, BeamsOf::kLaserAtRest, 1).p_value);
  }
  EXPECT_LT(test::unevenness(chances), test::kUnevenOnceInAHundred) << ::testing::PrintToString(chances);
}

TEST(ToldApart, PlainRangesAreAsOftenAsChanceHasIt) { expect_even({}, plain); }

TEST(ToldApart, RangesAboutTwoValuesAreAsOftenAsChanceHasIt) {
  expect_even(with_two_peaks(), about_two_values);
}

TEST(ToldApart, RangesAboutTwoValuesAreTheSimulatorsOnceThatIsFound) {
  const RangeErrors measured = shots(3, about_two_values, 1e-3, 200);
  const NoiseLaw found = diagnose_noise("laser1", measured, 1).law;
  ASSERT_TRUE(found.has_peaks());
  const ToldApart told = told_apart("laser1", measured, found, {}, BeamsOf::kLaserAtRest, 1);
  EXPECT_LT(told.before.p_value, 1e-12);
  EXPECT_GT(told.after.p_value, 0.05);
}

TEST(ToldApart, SpreadsOfEachBeamsOwnAreNoLawsOfTheSimulator) {
  const RangeErrors measured = shots(
      4, [](Random& random, int beam, int) { return (beam % 2 == 0 ? 4e-3 : 8e-3) * standard(random); });
  const NoiseLaw found = diagnose_noise("laser1", measured, 1).law;
  ASSERT_TRUE(found.has_relative());
  const ToldApart told = told_apart("laser1", measured, found, {}, BeamsOf::kLaserAtRest, 1);
  EXPECT_LT(told.after.p_value, 1e-12);
  const LikenessLook worst = *std::ranges::min_element(told.after.looks, {}, &LikenessLook::p_value);
  EXPECT_EQ(worst.quantity, "noise");
  EXPECT_EQ(worst.covariate, "beam");
  // About √(4² + 8²) / √2 = 6.3 mm, beams scatter by 2.3 mm less or 1.7 mm more: 2.0 mm RMS.
  EXPECT_NEAR(worst.amplitude, 2.0e-3, 0.2e-3);
}

TEST(ToldApart, AJumpOfAllRangesIsTheSimulatorsOnceThatIsFound) {
  Eigen::VectorXd jump = Eigen::VectorXd::Constant(kScans, -1e-3);
  jump.tail(kScans / 2).array() += 2e-3;
  const RangeErrors measured =
      shots(5, [&](Random& random, int, int scan) { return 4e-3 * standard(random) + jump[scan]; });
  const ToldApart told = told_apart("laser1", measured, {}, jump, BeamsOf::kLaserAtRest, 1);
  EXPECT_LT(told.before.p_value, 1e-6);
  const LikenessLook worst = *std::ranges::min_element(told.before.looks, {}, &LikenessLook::p_value);
  EXPECT_EQ(worst.quantity, "range");
  EXPECT_EQ(worst.covariate, "time");
  EXPECT_NEAR(worst.amplitude, 1e-3, 0.25e-3);  // three errors: of 50 means, each known to 0.5 mm
  EXPECT_GT(told.after.p_value, 0.05);
}

TEST(ToldApart, RangesThatFollowOneAnotherAreNot) {
  double last = 0;
  const RangeErrors measured =
      shots(6, [&](Random& random, int, int) { return last = 0.2 * last + 4e-3 * standard(random); });
  const Likeness told = beside_law(measured, {}, {}, BeamsOf::kLaserAtRest, 1);
  EXPECT_LT(told.p_value, 1e-6);
  const LikenessLook worst = *std::ranges::min_element(told.looks, {}, &LikenessLook::p_value);
  EXPECT_EQ(worst.covariate, "next scan");
  EXPECT_NEAR(worst.amplitude, 0.2, 0.05);
}

TEST(ToldApart, RangesOfASingleBeamAreLookedAtAsWell) {
  RangeErrors measured = shots(8, plain);
  std::ranges::fill(measured.beam, std::uint16_t{0});
  EXPECT_GT(beside_law(measured, {}, {}, BeamsOf::kSurfaces, 1).p_value, 0.05);
}

TEST(ToldApart, ADevicesStepsAreSimulatedToo) {
  constexpr double kStep = 8e-3;  // two standard deviations
  const Likeness told = beside_law(shots(7, plain, kStep), {}, {}, BeamsOf::kLaserAtRest, 1);
  EXPECT_GT(told.p_value, 0.05);
}

TEST(ToldApart, WhatNothingExplainsIsUnnamedOnce) {
  const Likeness left{.looks = {{"remission", "range", "m", 0.0028, 1e-30},
                                {"next beam", "correlation", "1", 0.18, 1e-20},
                                {"beam", "noise", "m", 0.002, 1e-9},
                                {"time", "noise", "m", 0.001, 0.05}},
                      .p_value = 1e-30};
  Findings all;
  all.unnamed = {{.covariate = "beam", .quantity = "noise", .scope = "laser1"}};
  add_left_over("laser1", left, 3, all);
  ASSERT_EQ(all.unnamed.size(), 3U) << "the beams' own noise is known, and one look may be chance";
  EXPECT_EQ(all.unnamed[1].covariate, "remission");
  EXPECT_EQ(all.unnamed[1].amplitude, 0.0028);
  EXPECT_EQ(all.unnamed[2].covariate, "next beam");
  EXPECT_EQ(all.unnamed[2].unit, "1");
  EXPECT_NE(headline(all.unnamed[2]).find("correlation of laser1 depends on the next beam, by 0.180"),
            std::string::npos);
  EXPECT_FALSE(all.unnamed[2].accepted);
}

}  // namespace
}  // namespace crisp
