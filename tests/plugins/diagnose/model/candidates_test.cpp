// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/diagnose/model/candidates.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include <crisp/sensor_model.hpp>

#include "tests/support/built_in_terms.hpp"

namespace crisp {
namespace {

using namespace crisp::diagnose;

constexpr const char* kPeriodic = "laser2.empirical.range_by_range_phase";

Calibration plain() { return nominal_calibration(default_rig()); }

/// A calibration whose second laser has a sine over range.
Calibration with_sine(double period) {
  Calibration calibration = plain();
  TermParameters sine = neutral_parameters(built_in_terms().get("range.cyclic")->info());
  sine.parameters.back().value = period;
  calibration.lasers[1].terms.push_back(sine);
  return calibration;
}

std::vector<Candidate> named(const Calibration& calibration, const std::string& name) {
  std::vector<Candidate> all = candidates(built_in_terms(), calibration, {.last = 10, .farthest = 8});
  std::erase_if(all, [&](const Candidate& one) { return one.name != name; });
  return all;
}

TEST(Candidates, HaveNoPeriodicShapeWithoutASine) { EXPECT_TRUE(named(plain(), kPeriodic).empty()); }

TEST(Candidates, HaveAPeriodicShapeAtThePeriodOfTheSine) {
  const auto found = named(with_sine(1.07), kPeriodic);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found.front().term.parameters.back().name, "P");
  EXPECT_DOUBLE_EQ(found.front().term.parameters.back().value, 1.07);
  EXPECT_EQ(found.front().cause_name(), "laser2.range.cyclic");
  EXPECT_TRUE(named(with_sine(1.07), "laser1.empirical.range_by_range_phase").empty());
}

TEST(Candidates, KeepAPeriodicShapeThatTheModelHas) {
  Calibration calibration = plain();
  TermParameters shape = neutral_parameters(built_in_terms().get("empirical.range_by_range_phase")->info());
  shape.parameters.front().value = 0.01;
  calibration.lasers[1].terms.push_back(shape);
  const auto found = named(calibration, kPeriodic);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_TRUE(found.front().in_model);
  EXPECT_DOUBLE_EQ(found.front().term.parameters.front().value, 0.01);
}

}  // namespace
}  // namespace crisp
