// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/estimate/static_surfaces.hpp"

#include <gmock/gmock.h>

#include "tests/pipeline/estimate/viewed_surfels.hpp"

namespace crisp {
namespace {

using namespace crisp::estimate;
using namespace crisp::quality;
using testing::ElementsAre;

constexpr double kRangeNoise = 0.01;

TEST(StaticSurfaces, LeavesOutWhatViewsMetAtAnotherPlaceThanElsewhere) {
  test::ViewedSurfels walls;
  walls.add({{.view = 0, .height = 0, .beams = 600}, {.view = 3, .height = 0.004, .beams = 60}});
  walls.add(
      {{.view = 0, .height = -0.06, .beams = 50}, {.view = 1, .height = 0.06, .beams = 50}});  // walked by
  walls.add({{.view = 2, .height = 0.001, .beams = 600}, {.view = 3, .height = 0, .beams = 60}});
  walls.add({{.view = 4, .height = 0.2, .beams = 60}});  // one view does not disagree with itself
  const auto keep = static_surfaces(walls.surfels, walls.view(), kRangeNoise);
  EXPECT_THAT(keep, ElementsAre(true, false, true, true));
  const Surfels rest = kept(walls.surfels, keep);
  ASSERT_EQ(rest.surfels.size(), 3U);
  EXPECT_EQ(rest.beams_of(rest.surfels[1]).front(), 760U) << "members stay where they are";
}

TEST(StaticSurfaces, BlamesACalibrationThatIsStillOffOnNoSurface) {
  test::ViewedSurfels walls;
  for (const double off : {0.05, 0.03, 0.06, 0.04}) {
    walls.add({{.view = 0, .height = -off, .beams = 100}, {.view = 2, .height = off, .beams = 100}});
  }
  EXPECT_THAT(static_surfaces(walls.surfels, walls.view(), kRangeNoise), ElementsAre(true, true, true, true));
}

TEST(StaticSurfaces, BlamesAModelThatIsWrongOnMostBeamsOnNoSurface) {
  test::ViewedSurfels room;
  for (int wall = 0; wall < 5; ++wall) {
    room.add({{.view = 0, .height = 0, .beams = 50}, {.view = 2, .height = 0, .beams = 50}});
  }
  for (int floor = 0; floor < 2; ++floor) {
    room.add({{.view = 0, .height = 0, .beams = 500}, {.view = 2, .height = 0.02, .beams = 500}});
  }
  room.add({{.view = 0, .height = 0, .beams = 50}, {.view = 2, .height = 0.3, .beams = 50}});  // walked by
  EXPECT_THAT(static_surfaces(room.surfels, room.view(), kRangeNoise),
              ElementsAre(true, true, true, true, true, true, true, false));
}

TEST(StaticSurfaces, CountsBeamsAsTheyWeigh) {
  test::ViewedSurfels walls;
  for (int k = 0; k < 3; ++k)
    walls.add({{.view = 0, .height = 0, .beams = 10}, {.view = 1, .height = 0, .beams = 10}});
  walls.add({{.view = 0, .height = 0, .beams = 90}, {.view = 1, .height = 0.5, .beams = 10}});
  for (std::size_t k = 150; k < 160; ++k) walls.surfels.weights[k] = 0;
  EXPECT_THAT(static_surfaces(walls.surfels, walls.view(), kRangeNoise), ElementsAre(true, true, true, true));
}

}  // namespace
}  // namespace crisp
