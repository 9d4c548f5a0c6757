// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/estimate/outcome.hpp"

#include <gmock/gmock.h>

#include <numbers>

namespace crisp {
namespace {

using namespace crisp::estimate;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

Outcome example() {
  Calibration start = nominal_calibration(default_rig());
  start.covariance_order = {"laser1.eta"};  // of an earlier run
  start.covariance = {1};
  start.lasers[2].lambda.value -= 2 * std::numbers::pi;
  start.lasers[1].tau.value = 0.2125;
  SensorModel model(start);
  Eigen::MatrixXd covariance(2, 2);
  covariance << 1e-8, 2e-9, 2e-9, 4e-8;
  return {.model = model,
          .free = {model.index("laser2.tau"), model.index("laser3.lambda")},
          .covariance = covariance,
          .unobservable = {{.parameter = "laser1.eta", .reason = "still", .combination = "x + y"}}};
}

TEST(Outcome, BecomesACalibrationWithItsErrors) {
  const Calibration calibration = calibration_of(example(), default_rig());
  EXPECT_THAT(calibration.covariance_order, ElementsAre("laser2.tau", "laser3.lambda"));
  EXPECT_THAT(calibration.covariance, ElementsAre(1e-8, 2e-9, 2e-9, 4e-8));
  EXPECT_TRUE(calibration.lasers[1].tau.free);
  EXPECT_DOUBLE_EQ(calibration.lasers[1].tau.std_error, 1e-4);
  EXPECT_DOUBLE_EQ(calibration.lasers[2].lambda.std_error, 2e-4);
  EXPECT_FALSE(calibration.lasers[0].tau.free);
  EXPECT_EQ(calibration.unobservable.size(), 1U);
}

TEST(Outcome, GivesAnglesWithinHalfATurnOfTheRigs) {
  const Calibration calibration = calibration_of(example(), default_rig());
  EXPECT_NEAR(calibration.lasers[2].lambda.value, 4 * std::numbers::pi / 3, 1e-12);
  Rig upside_down = default_rig();
  upside_down.lasers[0].nominal.alpha.value = std::numbers::pi;
  Calibration found = nominal_calibration(upside_down);
  found.lasers[0].alpha.value = -std::numbers::pi + 0.02;
  EXPECT_NEAR(with_angles_near(found, upside_down).lasers[0].alpha.value, std::numbers::pi + 0.02, 1e-12);
  found.lasers[0].alpha.value = std::numbers::pi - 0.02;
  EXPECT_EQ(with_angles_near(found, upside_down).lasers[0].alpha.value, std::numbers::pi - 0.02);
}

TEST(Outcome, IsTabledInMillimetresDegreesAndMilliseconds) {
  const std::string table = table_of(calibration_of(example(), default_rig()), default_rig());
  EXPECT_THAT(table, HasSubstr("laser2.tau                  212.5000 mm     0.1000    +12.5000"));
  EXPECT_THAT(table, HasSubstr("laser3.lambda               240.0000 deg    0.0115     +0.0000"));
  EXPECT_THAT(table,
              HasSubstr("laser1.eta                    0.0000 ms                +0.0000  not observable"));
  EXPECT_THAT(table, Not(HasSubstr("nan")));
}

TEST(Outcome, MarksAnUnobservableValueThatIsNotTheRigs) {
  Outcome moved = example();
  Calibration start = moved.model.calibration();
  start.lasers[0].eta.value = 2e-3;
  moved.model = SensorModel(start);
  EXPECT_THAT(table_of(calibration_of(moved, default_rig()), default_rig()),
              HasSubstr("+2.0000  not observable by itself"));
}

TEST(Outcome, IsTabledWithTwoDigitsOfEvenASmallError) {
  Outcome sure = example();
  sure.covariance(0, 0) = 1e-18;
  EXPECT_THAT(table_of(calibration_of(sure, default_rig()), default_rig()),
              HasSubstr("laser2.tau               212.5000000 mm  0.0000010  +12.5000000"));
}

}  // namespace
}  // namespace crisp
