// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/clock/scan_beams.hpp"

#include <gmock/gmock.h>

namespace crisp {
namespace {

using namespace crisp::clock;
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

TEST(ScanBeams, OfSeveralEchoesAreBeamsOfOneInstant) {
  auto scan = std::make_shared<Scan>();
  scan->laser = 2;
  scan->angle_step = 0.25;
  scan->timing = BeamTiming::stated;
  scan->beam_interval = 0.001;
  scan->echoes = {{.ranges = {1, 0, 2}, .remissions = {7, 0, 8}}, {.ranges = {3, 0, 0}}};
  Measurements beams;
  fill_measurements({.scan = std::move(scan), .begin = 10, .period = 8}, RigLaser{.mount = 0.5}, 0, beams);
  EXPECT_THAT(beams.range, ElementsAre(1, 3, 2));
  EXPECT_THAT(beams.remission, ElementsAre(7, 0, 8));
  EXPECT_THAT(beams.beam, ElementsAre(0, 0, 2));
  EXPECT_THAT(beams.time, ElementsAre(10, 10, DoubleNear(10.002, 1e-12)));
  EXPECT_THAT(beams.mirror_angle, ElementsAre(-0.5F, -0.5F, 0));
  EXPECT_THAT(beams.laser, ElementsAre(2, 2, 2));
}

}  // namespace
}  // namespace crisp
