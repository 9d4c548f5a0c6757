// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/calibrate/load_stage.hpp"

#include <gmock/gmock.h>

#include <crisp/calibration_file.hpp>
#include <crisp/effect_catalogue.hpp>
#include <crisp/registrar.hpp>

#include "tests/support/stage_driver.hpp"
#include "tests/support/temporary_folder.hpp"

namespace crisp {
namespace {

using namespace crisp::calibrate;
using testing::ElementsAre;
using testing::HasSubstr;

Calibration of_lasers(const std::vector<std::string>& names) {
  Calibration calibration;
  for (const auto& name : names) calibration.lasers.emplace_back().name = name;
  return calibration;
}

TEST(LoadCalibration, PutsTheLasersIntoTheOrderOfTheRig) {
  const auto ordered = ordered_as(default_rig(), of_lasers({"laser3", "spare", "laser1", "laser2"}));
  ASSERT_EQ(ordered.lasers.size(), 3u);
  EXPECT_EQ(ordered.lasers[0].name, "laser1");
  EXPECT_EQ(ordered.lasers[1].name, "laser2");
  EXPECT_EQ(ordered.lasers[2].name, "laser3");
}

TEST(LoadCalibration, RefusesTheCalibrationOfAnotherRig) {
  try {
    ordered_as(default_rig(), of_lasers({"laser1", "laser2"}));
    FAIL();
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), HasSubstr("has no laser 'laser3'"));
  }
}

TEST(LoadCalibration, ReportsWhichTermsHoldForOneRecordingAlone) {
  const test::TemporaryFolder folder;
  TermRegistry terms;
  register_built_in(terms);
  Registrar registrar;
  registrar.attach(terms);
  Calibration calibration = nominal_calibration(default_rig());
  calibration.plate_terms = {neutral_parameters(terms.get("encoder.eccentricity")->info())};
  for (const auto* name : {"range.step", "range.offset"}) {
    calibration.lasers[2].terms.push_back(neutral_parameters(terms.get(name)->info()));
  }
  write_calibration(folder / "calibration.yaml", calibration);
  auto stage = test::StageDriver::of<LoadCalibrationStage>(
      {{"file", OptionScalar((folder / "calibration.yaml").string())}});
  stage.run().registrar = &registrar;
  stage.feed();
  EXPECT_THAT(stage.report().warnings, ElementsAre(HasSubstr("laser3.range.step: a term of the time")));
  EXPECT_THAT(stage.report().lines,
              ElementsAre(HasSubstr("encoder.eccentricity: a term of the plate's angle")));
}

TEST(LoadCalibration, MarksAnUntrustedCalibrationUntrusted) {
  const test::TemporaryFolder folder;
  TermRegistry terms;
  Registrar registrar;
  registrar.attach(terms);
  Calibration calibration = nominal_calibration(default_rig());
  calibration.caveats = {"the plate stood still"};
  const std::string file = (folder / "calibration.yaml").string();
  write_calibration(file, calibration);
  auto stage = test::StageDriver::of<LoadCalibrationStage>({{"file", OptionScalar(file)}});
  stage.run().registrar = &registrar;
  stage.feed();
  EXPECT_THAT(stage.report().caveats,
              ElementsAre("the calibration " + file +
                          " was already untrusted when it was made: the plate stood still"));
}

}  // namespace
}  // namespace crisp
