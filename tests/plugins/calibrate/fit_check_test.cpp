// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/calibrate/fit_check.hpp"

#include <gmock/gmock.h>

namespace crisp {
namespace {

using namespace crisp::calibrate;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// Beams each tenth of a second, of each laser until its end [s].
Measurements beams_until(const std::vector<double>& ends) {
  Measurements beams;
  for (int i = 0; i <= 100; ++i) {
    const double time = 0.1 * i;
    for (std::size_t laser = 0; laser < ends.size(); ++laser) {
      if (time > ends[laser]) continue;
      beams.time.push_back(time);
      beams.laser.push_back(static_cast<std::uint16_t>(laser));
    }
  }
  beams.range.resize(beams.time.size(), 1);
  return beams;
}

TEST(FitCheck, LasersThatAreHeardForMostOfTheRecordingHaveNoCaveat) {
  EXPECT_THAT(check_silence(beams_until({10, 5.05, 8}), default_rig()), IsEmpty());
}

TEST(FitCheck, NamesALaserThatWasHeardForLessThanHalf) {
  EXPECT_THAT(check_silence(beams_until({10, 4, 10}), default_rig()),
              ElementsAre(HasSubstr("laser2 was heard for 4.0 s of 10.0 s")));
}

TEST(FitCheck, NamesALaserWithoutBeams) {
  EXPECT_THAT(check_silence(beams_until({10, 10, -1}), default_rig()),
              ElementsAre(HasSubstr("there are no beams of laser3: its values are the rig's")));
  Rig one_device = default_rig();
  for (RigLaser& laser : one_device.lasers) laser.address = {};
  EXPECT_THAT(check_silence(beams_until({10, 10, -1}), one_device), IsEmpty());
}

}  // namespace
}  // namespace crisp
