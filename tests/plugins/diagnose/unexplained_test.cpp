// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/diagnose/unexplained.hpp"

#include <gtest/gtest.h>

namespace crisp {
namespace {

constexpr double kRangeNoise = 0.010;  // [m]

/// Takes so much [m] of the residuals.
Departure of_laser(std::size_t laser, double takes, const std::string& over = "") {
  Departure one;
  one.candidate.owner = laser;
  one.candidate.term.term = over.empty() ? "range.scale" : "empirical.range_by_" + over;
  one.candidate.name = "laser" + std::to_string(laser + 1) + "." + one.candidate.term.term;
  one.candidate.covariate = over;
  one.look.visible = takes / kRangeNoise;
  return one;
}

Departure of_plate(double takes) {
  Departure one;
  one.candidate.owner = 2;
  one.candidate.term.term = one.candidate.name = "plate.wobble";
  one.look.visible = takes / kRangeNoise;
  return one;
}

/// Half of the beams are each laser's.
Profile over(const char* covariate, std::size_t laser, double rms) {
  return {.covariate = covariate,
          .unit = "",
          .laser = laser,
          .bins = {},
          .share = 0.5,
          .rms = rms,
          .p_value = 1e-9};
}

TEST(Unexplained, ACauseThatTakesLessThanWhatIsLeftInItsLaserIsRefused) {
  SideBySide left;
  left.profiles = {over("range", 0, 0.004), over("time", 0, 0.001)};  // 2.8 mm over all beams
  std::vector<Departure> found = {of_laser(0, 0.0027), of_laser(0, 0.0029), of_laser(1, 0.001),
                                  of_plate(0.0027), of_plate(0.0029)};
  EXPECT_TRUE(refuse_what_leaves_more(found, left, kRangeNoise));
  EXPECT_FALSE(found[0].accepted);
  EXPECT_NE(found[0].refused, "");
  EXPECT_NEAR(found[0].unexplained, 8e-6, 1e-12) << "over the covariate that shows the most";
  EXPECT_TRUE(found[1].accepted);
  EXPECT_TRUE(found[2].accepted) << "nothing departs in its ranges";
  EXPECT_FALSE(found[3].accepted) << "the plate changes all ranges";
  EXPECT_TRUE(found[4].accepted);
}

TEST(Unexplained, WhatAShapeTookThatDoesNotSufficeCountsWithIt) {
  SideBySide left;
  left.profiles = {over("range", 0, 0.002)};
  std::vector<Departure> found = {of_laser(0, 0.003), of_laser(0, 0.004, "range")};
  EXPECT_TRUE(refuse_what_leaves_more(found, left, kRangeNoise));
  EXPECT_FALSE(found[0].accepted);
  EXPECT_NEAR(found[0].unexplained, 18e-6, 1e-12);
  EXPECT_TRUE(found[1].accepted) << "a shape claims no more than to describe";
  found = {of_laser(0, 0.003), of_laser(0, 0.004, "time")};
  EXPECT_FALSE(refuse_what_leaves_more(found, left, kRangeNoise)) << "over time nothing is left";
}

TEST(Unexplained, WhatARefusedOneTookIsHeldAgainstTheOthers) {
  SideBySide left;
  left.profiles = {over("range", 0, 0.002)};
  std::vector<Departure> found = {of_laser(0, 0.001), of_laser(0, 0.002)};
  found[1].candidate.name = "laser1.range.intensity";
  EXPECT_TRUE(refuse_what_leaves_more(found, left, kRangeNoise));
  EXPECT_FALSE(found[0].accepted);
  EXPECT_TRUE(found[1].accepted);
  EXPECT_FALSE(refuse_what_leaves_more(found, left, kRangeNoise)) << "settled, if no more is left without it";
  left.profiles = {over("range", 0, 0.005)};
  EXPECT_TRUE(refuse_what_leaves_more(found, left, kRangeNoise));
  EXPECT_FALSE(found[1].accepted);
  EXPECT_FALSE(refuse_what_leaves_more(found, left, kRangeNoise)) << "none is left";
}

}  // namespace
}  // namespace crisp
