// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/calibrate/watch/watch_stage.hpp"

#include <gmock/gmock.h>

#include <fstream>

#include <crisp/registrar.hpp>

#include "tests/plugins/calibrate/watch/support.hpp"
#include "tests/support/stage_driver.hpp"
#include "tests/support/temporary_folder.hpp"

namespace crisp {
namespace {

using namespace crisp::calibrate;
using namespace crisp::data;
using namespace crisp::simulate;

using Options = std::map<std::string, OptionValue>;

/// The stage with an office of three seconds and a calibration from above.
class WatchStageTest : public testing::Test {
 protected:
  WatchStageTest() { registrar_.attach(terms_); }

  test::StageDriver run(const Calibration& calibration, Options options) {
    options.emplace("seconds", OptionScalar(2.5));
    auto stage = test::StageDriver::of<WatchStage>(options);
    stage.run().registrar = &registrar_;
    const auto above = std::make_shared<const Calibration>(calibration);
    for (const auto& batch : test::batches_of(simulated())) stage.feed(batch.beams, batch.plate, above);
    stage.finish();
    return stage;
  }

  static OptionValue text(const std::string& value) { return OptionScalar(value); }

  TermRegistry terms_;
  Registrar registrar_;
  static const SimulatedMeasurements& simulated() {
    static const SimulatedMeasurements three_seconds = test::recorded(3);
    return three_seconds;
  }
};

TEST_F(WatchStageTest, PassesAGoodCalibrationOnAndIsContent) {
  const auto stage = run(simulated().truth, {});
  EXPECT_EQ(stage.given<Calibration>().size(), 1U);
  EXPECT_EQ(stage.report().section["checks"], 1);
  EXPECT_EQ(stage.report().section["stale"], 0);
  EXPECT_THAT(stage.report().caveats, testing::IsEmpty());
}

TEST_F(WatchStageTest, ReportsThatACalibrationHasGoneStale) {
  const auto stage = run(test::pushed(simulated().truth), {});
  EXPECT_EQ(stage.given<Calibration>().size(), 1U) << "it is not to be replaced";
  EXPECT_THAT(stage.report().warnings,
              testing::ElementsAre(testing::StartsWith("the calibration is stale: laser2.alpha by -0.")));
  EXPECT_THAT(stage.report().caveats, testing::SizeIs(1));
}

TEST_F(WatchStageTest, ReplacesAStaleOneWhereItMay) {
  const auto stage = run(test::pushed(simulated().truth),
                         {{"recalibrate", text("when_stale")}, {"recalibrate_parameters", text("all")}});
  const auto given = stage.given<Calibration>();
  ASSERT_EQ(given.size(), 2U);
  EXPECT_NEAR(given[1]->lasers[1].alpha.value, simulated().truth.lasers[1].alpha.value,
              5 * given[1]->lasers[1].alpha.std_error);
  EXPECT_THAT(stage.report().caveats, testing::IsEmpty());
}

TEST_F(WatchStageTest, FindsTheLagsOfAStartAndNothingElse) {
  Calibration before = simulated().truth;
  before.lasers[1].eta.value = 0;
  const auto stage = run(before, {{"recalibrate", text("at_start")}});
  const auto given = stage.given<Calibration>();
  ASSERT_EQ(given.size(), 2U);
  EXPECT_NEAR(given[1]->lasers[1].eta.value, 2e-3, 0.1e-3);
  EXPECT_EQ(given[1]->lasers[1].tau.value, before.lasers[1].tau.value);
  EXPECT_THAT(stage.report().caveats, testing::IsEmpty()) << "it is good again";
}

TEST_F(WatchStageTest, ReportsThatTheGeometryIsStaleWhereLagsAloneAreRenewed) {
  const auto stage = run(test::pushed(simulated().truth, 1.5 * kDegree), {{"recalibrate", text("at_start")}});
  EXPECT_EQ(stage.given<Calibration>().size(), 2U);
  EXPECT_THAT(stage.report().caveats, testing::SizeIs(1));
}

TEST_F(WatchStageTest, RecalibratesWhenAPersonRequestsIt) {
  const test::TemporaryFolder folder;
  std::ofstream(folder / "recalibrate") << "please";
  const auto stage = run(simulated().truth, {{"request", text((folder / "recalibrate").string())}});
  EXPECT_FALSE(std::filesystem::exists(folder / "recalibrate"));
  EXPECT_EQ(stage.given<Calibration>().size(), 2U);
}

}  // namespace
}  // namespace crisp
