// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/calibrate/sequential_calibration.hpp"

#include <gmock/gmock.h>

#include <crisp/rig.hpp>

namespace crisp {
namespace {

using namespace crisp::calibrate;
using estimate::Orientation;
using testing::ElementsAre;

/// Of the default rig's three lasers.
estimate::Refinement with_views(std::vector<estimate::ViewConsistency> views) {
  TermRegistry terms;
  return {.outcome = {.model = SensorModel(nominal_calibration(default_rig()), terms)},
          .views = std::move(views)};
}

estimate::ViewConsistency pair(const std::string& view, const std::string& other, double share,
                               Orientation orientation = Orientation::upright) {
  return {.view = view, .other = other, .orientation = orientation, .beams = 1000, .share = share};
}

TEST(AgreeingLasers, AreThoseThatTheFirstOneReachesByOthers) {
  EXPECT_THAT(agreeing_lasers(with_views({pair("laser1", "laser2", 0.9), pair("laser2", "laser1", 0.9),
                                          pair("laser2", "laser3", 0.8), pair("laser3", "laser2", 0.8),
                                          pair("laser1", "laser3", 0.2), pair("laser3", "laser1", 0.3)})),
              ElementsAre(true, true, true));
  EXPECT_THAT(agreeing_lasers(with_views({pair("laser2", "laser3", 0.9), pair("laser3", "laser2", 0.9),
                                          pair("laser1", "laser3", 0.2), pair("laser3", "laser1", 0.3)})),
              ElementsAre(true, false, false));
}

TEST(AgreeingLasers, AgreeSeenFromEither) {
  EXPECT_THAT(agreeing_lasers(with_views({pair("laser1", "laser2", 0.9), pair("laser2", "laser1", 0.3),
                                          pair("laser1", "laser3", 0.9), pair("laser3", "laser1", 0.9)})),
              ElementsAre(true, false, true));
}

TEST(AgreeingLasers, AreJudgedByWallsAndNotByFloors) {
  EXPECT_THAT(agreeing_lasers(with_views({pair("laser1", "laser2", 0.3), pair("laser2", "laser1", 0.3),
                                          pair("laser2", "laser1", 0.99, Orientation::level)})),
              ElementsAre(true, false, true))
      << "floors do not show lambda, and laser3 has no walls that could contradict";
}

}  // namespace
}  // namespace crisp
