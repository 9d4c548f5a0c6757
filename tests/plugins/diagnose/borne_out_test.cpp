// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/diagnose/borne_out.hpp"

#include <gtest/gtest.h>

#include "tests/support/built_in_terms.hpp"

namespace crisp {
namespace {

/// A model with a range.offset and a range.intensity of the first laser, and what they are estimated to be.
Outcome outcome(double offset, double a, double b) {
  Calibration calibration = nominal_calibration(default_rig());
  const auto add = [&](const std::string& name, const std::vector<double>& values) {
    TermParameters term = neutral_parameters(built_in_terms().get(name)->info());
    for (std::size_t p = 0; p < values.size(); ++p) term.parameters[p].value = values[p];
    calibration.lasers[0].terms.push_back(term);
  };
  add("range.offset", {offset});
  add("range.intensity", {a, b});
  Outcome result{
      .model = SensorModel(calibration, built_in_terms()), .free = {}, .covariance = {}, .unobservable = {}};
  const auto& names = result.model.names();
  for (const std::string name :
       {"laser1.tau", "laser1.range.offset.c", "laser1.range.intensity.a", "laser1.range.intensity.b"}) {
    result.free.push_back(static_cast<std::size_t>(std::ranges::find(names, name) - names.begin()));
  }
  result.covariance = 1e-6 * Eigen::MatrixXd::Identity(4, 4);
  result.covariance(2, 3) = result.covariance(3, 2) = 0.98e-6;
  return result;
}

Departure of_first_laser(const std::string& term) {
  Departure one;
  one.candidate.owner = 0;
  one.candidate.name = "laser1." + term;
  one.candidate.term = neutral_parameters(built_in_terms().get(term)->info());
  return one;
}

TEST(BorneOut, WhatComesOutAsNothingIsRefused) {
  std::vector<Departure> found = {of_first_laser("range.offset"), of_first_laser("range.intensity")};
  EXPECT_FALSE(refuse_what_is_not_borne_out(found, outcome(0.004, 0.005, 0), built_in_terms(), 1e-3));
  EXPECT_TRUE(refuse_what_is_not_borne_out(found, outcome(0.003, 0.005, 0), built_in_terms(), 1e-3))
      << "three standard errors";
  EXPECT_FALSE(found[0].accepted);
  EXPECT_NE(found[0].refused, "");
  EXPECT_TRUE(found[1].accepted);
}

TEST(BorneOut, WhatSeveralLasersHaveAlikeAndIsSmallMayBeTheScenes) {
  const auto seen = [](const std::string& term, std::size_t laser, double visible) {
    Departure one = of_first_laser(term);
    one.candidate.owner = laser;
    one.candidate.name = "laser" + std::to_string(laser + 1) + "." + term;
    one.look.visible = visible;
    return one;
  };
  std::vector<Departure> found = {seen("range.intensity", 0, 0.03), seen("range.intensity", 2, 0.04),
                                  seen("range.offset", 0, 0.03), seen("range.offset", 1, 0.11),
                                  seen("range.scale", 1, 0.01)};
  refuse_what_may_be_the_scenes(found);
  const auto accepted = [&](std::size_t k) { return found.at(k).accepted; };
  EXPECT_FALSE(accepted(0) || accepted(1));
  EXPECT_NE(found[0].refused, "");
  EXPECT_TRUE(accepted(2) && accepted(3)) << "one of them is large";
  EXPECT_TRUE(accepted(4)) << "of one laser alone";
}

TEST(BorneOut, ParametersOfATermAreAskedTogether) {
  std::vector<Departure> alike = {of_first_laser("range.intensity")};
  EXPECT_TRUE(refuse_what_is_not_borne_out(alike, outcome(0, 0.003, 0.003), built_in_terms(), 1e-3));
  std::vector<Departure> opposed = {of_first_laser("range.intensity")};
  EXPECT_FALSE(refuse_what_is_not_borne_out(opposed, outcome(0, 0.001, -0.001), built_in_terms(), 1e-3))
      << "they vary together";
}

}  // namespace
}  // namespace crisp
