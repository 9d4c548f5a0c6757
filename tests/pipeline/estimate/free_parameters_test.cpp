// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/estimate/free_parameters.hpp"

#include <gmock/gmock.h>

#include <crisp/error.hpp>
#include <crisp/rig.hpp>

namespace crisp {
namespace {

using namespace crisp::estimate;
using testing::ElementsAre;

Measurements beams_of(const std::vector<std::uint16_t>& lasers) {
  Measurements beams;
  for (const auto laser : lasers) {
    beams.range.push_back(1);
    beams.mirror_angle.push_back(0);
    beams.time.push_back(0);
    beams.laser.push_back(laser);
    beams.remission.push_back(0);
    beams.beam.push_back(0);
  }
  return beams;
}

std::vector<std::string> names_of(const FreeParameters& parameters, const SensorModel& model) {
  std::vector<std::string> names;
  for (const auto slot : parameters.free) names.push_back(model.names()[slot]);
  return names;
}

const SensorModel kModel(nominal_calibration(default_rig()));

TEST(FreeParameters, AreAllButTheFirstLambda) {
  const auto parameters = free_parameters(kModel, beams_of({0, 1, 2}), {});
  EXPECT_EQ(parameters.free.size(), 11U);
  EXPECT_EQ(kModel.names()[parameters.free[0]], "laser1.tau");
  EXPECT_TRUE(parameters.unobservable.empty());
}

TEST(FreeParameters, OfALaserThatMeasuredNothingAreUnobservableAndTheNextLaserIsTheReference) {
  const auto parameters = free_parameters(kModel, beams_of({1, 2}), {"tau", "laser3.eta"});
  EXPECT_THAT(names_of(parameters, kModel),
              ElementsAre("laser2.alpha", "laser2.eta", "laser3.lambda", "laser3.alpha"));
  ASSERT_EQ(parameters.unobservable.size(), 4U);
  EXPECT_EQ(parameters.unobservable[0].parameter, "laser1.lambda");
}

TEST(FreeParameters, ThatNobodyKnowsAreRefused) {
  const auto rig = nominal_calibration(default_rig());
  EXPECT_NO_THROW(check_fixed({"eta", "laser2.tau"}, rig));
  EXPECT_THROW(check_fixed({"laser4.eta"}, rig), Error);
  EXPECT_THROW(check_fixed({"laser1.beta"}, rig), Error);
}

TEST(LagRange, SpansAllLasersWithItsMargin) {
  auto calibration = nominal_calibration(default_rig());
  calibration.lasers[0].eta.value = 0.02;
  calibration.lasers[2].eta.value = -0.03;
  const auto range = lag_range(SensorModel(calibration), 0.01);
  EXPECT_DOUBLE_EQ(range.earliest, -0.04);
  EXPECT_DOUBLE_EQ(range.latest, 0.03);
}

}  // namespace
}  // namespace crisp
