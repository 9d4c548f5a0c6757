// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/diagnose/model/model_stage.hpp"

#include <gmock/gmock.h>

#include <crisp/registrar.hpp>

#include "tests/plugins/diagnose/hidden.hpp"
#include "tests/support/stage_driver.hpp"

namespace crisp {
namespace {

using namespace crisp::diagnose;
using namespace crisp::simulate;
using testing::Contains;
using testing::HasSubstr;

/// Runs diagnose.model on a recording, starting from a calibration without terms.
StageReport report_of(const test::Recording& recording, const Findings& before = {}) {
  TermRegistry terms = built_in_terms();
  Registrar registrar;
  registrar.attach(terms);
  auto stage = test::StageDriver::of<DiagnoseModelStage>({{"beams", OptionScalar(std::int64_t{40'000})}});
  stage.run().rig = recording.scanner.rig;
  stage.run().registrar = &registrar;
  stage.feed(before);
  stage.feed(recording.made.beams, recording.made.plate, nominal_calibration(recording.scanner.rig));
  stage.finish();
  return stage.report();
}

/// The trajectory without its first and last `seconds`, so that it does not cover all beams.
PlateTrajectory trimmed(const PlateTrajectory& plate, double seconds) {
  std::vector<double> times;
  std::vector<double> angles;
  for (std::size_t i = 0; i < plate.size(); ++i) {
    const double time = plate.times()[i];
    if (time < plate.begin() + seconds || time > plate.end() - seconds) continue;
    times.push_back(time);
    angles.push_back(plate.angles()[i]);
  }
  return {plate.epoch_ns(), std::move(times), std::move(angles), plate.max_gap()};
}

TEST(DiagnoseModel, PrintsTheExtendedCalibrationAndResolvesCaveats) {
  const StageReport report = report_of(test::hidden(7, 4, office(), {{"laser1.range.offset", {0.012}}}));
  EXPECT_THAT(report.caveats, testing::IsEmpty());
  EXPECT_THAT(report.lines, Contains(testing::AllOf(HasSubstr("std error"), HasSubstr("laser1.tau"),
                                                    HasSubstr("laser1.range.offset.c"))));
  ASSERT_THAT(report.lifted, testing::SizeIs(1));
  EXPECT_EQ(report.lifted.begin()->first, "Calibration");
}

TEST(DiagnoseModel, KeepsACompleteCalibrationAndItsCaveats) {
  const StageReport report = report_of(test::hidden(7, 4, office(), {}));
  EXPECT_THAT(report.lines, testing::Not(Contains(HasSubstr("std error"))));
  EXPECT_THAT(report.lifted, testing::IsEmpty());
}

TEST(DiagnoseModel, ExcludesAMirrorPeriodThatStampsDetermine) {
  const auto recording = test::hidden(24, 10, office(), {{"laser1.timing.intra_scan", {2e-6}}});
  Findings stamps;
  stamps.devices.push_back(
      {.device = "laser1", .period = 0.02, .period_std_error = 2e-6, .nominal_period = 0.02});
  const auto reported = testing::PrintToString(report_of(recording, stamps).lines);
  EXPECT_THAT(reported, HasSubstr("laser1.timing.intra_scan"));
  EXPECT_THAT(reported, testing::Not(HasSubstr("mirror.period of laser1")));
  EXPECT_THAT(reported, testing::Not(HasSubstr("laser1.mirror.period")));
}

TEST(DiagnoseModel, FollowsEtasThatMoveFartherThanTheirPrior) {
  auto recording = test::hidden(7, 4, office(), {});
  recording.made.plate = trimmed(recording.made.plate, 0.5);
  for (double& time : recording.made.beams.time) time += 0.025;
  EXPECT_THAT(report_of(recording).lines, Contains(HasSubstr("no cause")));
}

}  // namespace
}  // namespace crisp
