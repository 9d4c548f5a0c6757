// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/clock/scan_beams.hpp"

#include <gmock/gmock.h>

namespace crisp {
namespace {

using ::testing::DoubleNear;
using ::testing::ElementsAre;

Measurements measured(BeamTiming timing, double angle_step) {
  auto scan = std::make_shared<Scan>();
  scan->start_angle = 0.5;
  scan->angle_step = angle_step;
  scan->timing = timing;
  scan->beam_interval = 0.001;
  scan->echoes = {{.ranges = {1, 0, 2}}};
  Measurements out;
  fill_measurements({.scan = std::move(scan), .begin = 10, .period = 8}, RigLaser{}, 0, out);
  return out;
}

TEST(ScanBeams, OfAScanThatStatesItsTimesFollowItsStamp) {
  for (const double step : {0.25, -0.25}) {
    const auto beams = measured(BeamTiming::stated, step);
    EXPECT_THAT(beams.time, ElementsAre(10, DoubleNear(10.002, 1e-12))) << "whichever way the mirror turns";
    EXPECT_FLOAT_EQ(beams.mirror_angle[1], static_cast<float>(0.5 + 2 * step));
  }
}

TEST(ScanBeams, OfOtherScansFollowTheMirrorFromMinus45Degrees) {
  constexpr double kEighth = 0.78539816339744831;
  const auto beams = measured(BeamTiming::mirror, kEighth);
  const double first = 10 + (0.5 + kEighth) / (8 * kEighth) * 8;
  EXPECT_THAT(beams.time, ElementsAre(DoubleNear(first, 1e-12), DoubleNear(first + 2, 1e-12)));
}

}  // namespace
}  // namespace crisp
