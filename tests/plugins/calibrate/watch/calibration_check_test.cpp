// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/calibrate/watch/calibration_check.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <crisp/error.hpp>

#include "tests/plugins/calibrate/watch/support.hpp"

namespace crisp {
namespace {

using namespace crisp::calibrate;
using namespace crisp::data;
using namespace crisp::simulate;

constexpr auto kGoOn = [] { return true; };

CalibrationCheck check(const Calibration& calibration, const SimulatedMeasurements& simulated,
                       RecalibrationPolicy policy = RecalibrationPolicy::No,
                       RecalibratedParameters parameters = RecalibratedParameters::All) {
  return check_calibration(calibration, {.beams = simulated.beams, .plate = &simulated.plate}, default_rig(),
                           {}, {.parameters = parameters}, policy, kGoOn);
}

TEST(CalibrationCheck, FindsTheTruthGood) {
  const auto simulated = test::recorded(3);
  const CalibrationCheck found = check(simulated.truth, simulated);
  EXPECT_FALSE(found.stale) << found.moved;
  EXPECT_NEAR(found.rqe, found.best_rqe, 1e-3);
  EXPECT_FALSE(check(simulated.truth, simulated, RecalibrationPolicy::IfStale).recalibration);
}

TEST(CalibrationCheck, NamesTheParameterThatMovedAndFindsItAnew) {
  const auto simulated = test::recorded(3);
  const CalibrationCheck found =
      check(test::pushed(simulated.truth), simulated, RecalibrationPolicy::IfStale);
  EXPECT_TRUE(found.stale);
  EXPECT_GT(found.rqe, found.best_rqe + 0.006);
  ASSERT_TRUE(found.recalibration);
  EXPECT_EQ(found.recalibration->rqe, found.best_rqe);
  const Parameter& alpha = found.recalibration->calibration.lasers[1].alpha;
  EXPECT_NEAR(alpha.value, simulated.truth.lasers[1].alpha.value, 5 * alpha.std_error);
  const double by = alpha.value - test::pushed(simulated.truth).lasers[1].alpha.value;
  EXPECT_THAT(found.moved, testing::StartsWith(fmt::format("laser2.alpha by {:.2g} deg", by / kDegree)));
}

TEST(CalibrationCheck, FindsLagsAnewAndLeavesWhatIsKnownOfTheGeometry) {
  const auto simulated = test::recorded(3);
  Calibration before = simulated.truth;
  before.lasers[1].tau.std_error = 1e-3;
  before.lasers[1].eta.value = 0;
  const CalibrationCheck found =
      check(before, simulated, RecalibrationPolicy::Yes, RecalibratedParameters::Lags);
  EXPECT_THAT(found.moved, testing::StartsWith("laser2.eta by 2 ms"));
  ASSERT_TRUE(found.recalibration);
  EXPECT_NEAR(found.recalibration->rqe, found.best_rqe, 1e-3);
  const LaserCalibration& laser = found.recalibration->calibration.lasers[1];
  EXPECT_NEAR(laser.eta.value, 2e-3, 5 * laser.eta.std_error);
  EXPECT_LT(laser.eta.std_error, 0.1e-3);
  EXPECT_EQ(laser.tau.value, before.lasers[1].tau.value);
  EXPECT_EQ(laser.tau.std_error, 1e-3);
}

TEST(CalibrationCheck, CanBeStopped) {
  const auto simulated = test::recorded(1);
  int requested = 0;
  check_calibration(test::pushed(simulated.truth), {.beams = simulated.beams, .plate = &simulated.plate},
                    default_rig(), {}, {}, RecalibrationPolicy::No, [&] { return ++requested < 2; });
  EXPECT_EQ(requested, 2);
}

}  // namespace
}  // namespace crisp
