// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/calibrate/load_stage.hpp"

#include <gmock/gmock.h>

namespace crisp {
namespace {

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

}  // namespace
}  // namespace crisp
