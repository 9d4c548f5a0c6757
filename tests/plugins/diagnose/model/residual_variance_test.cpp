// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/diagnose/model/residual_variance.hpp"

#include <gtest/gtest.h>

namespace crisp {
namespace {

using namespace crisp::diagnose;

constexpr double kRangeNoise = 0.010;  // [m]

/// A hypothesis that explains so much [m] of the residuals of one laser.
Hypothesis of_laser(std::size_t laser, double takes, const std::string& over = "") {
  Hypothesis one;
  one.candidate.owner = laser;
  one.candidate.term.term = over.empty() ? "range.scale" : "empirical.range_by_" + over;
  one.candidate.name = "laser" + std::to_string(laser + 1) + "." + one.candidate.term.term;
  one.candidate.covariate = over;
  one.candidate.family = over.empty() ? "range.scale" : "";
  one.test.visible = takes / kRangeNoise;
  return one;
}

Hypothesis of_plate(double takes) {
  Hypothesis one;
  one.candidate.owner = 2;
  one.candidate.term.term = one.candidate.name = one.candidate.family = "plate.wobble";
  one.test.visible = takes / kRangeNoise;
  return one;
}

/// Profile of a laser with half of the beams.
Profile over(const char* covariate, std::size_t laser, double rms) {
  return {.covariate = covariate,
          .unit = "",
          .laser = laser,
          .bins = {},
          .share = 0.5,
          .rms = rms,
          .p_value = 1e-9};
}

TEST(ResidualVariance, RejectsACauseBelowTheResidualOfItsLaser) {
  ProfileComparison left;
  left.profiles = {over("range", 0, 0.004), over("time", 0, 0.001)};  // 2.8 mm over all beams
  std::vector<Hypothesis> found = {of_laser(0, 0.0027), of_laser(0, 0.0029), of_laser(1, 0.001),
                                   of_plate(0.0027), of_plate(0.0029)};
  EXPECT_TRUE(reject_if_residual_exceeds(found, left, kRangeNoise));
  EXPECT_FALSE(found[0].accepted);
  EXPECT_NE(found[0].rejected, "");
  EXPECT_NEAR(found[0].tests.back().threshold, 8e-6, 1e-12) << "over the covariate of the largest deviation";
  EXPECT_TRUE(found[1].accepted);
  EXPECT_TRUE(found[2].accepted) << "no deviation of its ranges";
  EXPECT_FALSE(found[3].accepted) << "the plate changes all ranges";
  EXPECT_TRUE(found[4].accepted);
}

TEST(ResidualVariance, IncludesAFittedShapeThatDoesNotSuffice) {
  ProfileComparison left;
  left.profiles = {over("range", 0, 0.002)};
  std::vector<Hypothesis> found = {of_laser(0, 0.003), of_laser(0, 0.004, "range")};
  EXPECT_TRUE(reject_if_residual_exceeds(found, left, kRangeNoise));
  EXPECT_FALSE(found[0].accepted);
  EXPECT_NEAR(found[0].tests.back().threshold, 18e-6, 1e-12);
  EXPECT_TRUE(found[1].accepted) << "a shape is a description only";
  found = {of_laser(0, 0.003), of_laser(0, 0.004, "time")};
  EXPECT_FALSE(reject_if_residual_exceeds(found, left, kRangeNoise)) << "no residual over time";
}

TEST(ResidualVariance, IncludesTheEffectOfARejectedCause) {
  ProfileComparison left;
  left.profiles = {over("range", 0, 0.002)};
  std::vector<Hypothesis> found = {of_laser(0, 0.001), of_laser(0, 0.002)};
  found[1].candidate.name = "laser1.range.intensity";
  EXPECT_TRUE(reject_if_residual_exceeds(found, left, kRangeNoise));
  EXPECT_FALSE(found[0].accepted);
  EXPECT_TRUE(found[1].accepted);
  EXPECT_FALSE(reject_if_residual_exceeds(found, left, kRangeNoise))
      << "settled if its removal leaves no more";
  left.profiles = {over("range", 0, 0.005)};
  EXPECT_TRUE(reject_if_residual_exceeds(found, left, kRangeNoise));
  EXPECT_FALSE(found[1].accepted);
  EXPECT_FALSE(reject_if_residual_exceeds(found, left, kRangeNoise)) << "no accepted cause remains";
}

}  // namespace
}  // namespace crisp
