// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/simulate/scenes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "grabbers/simulate/random.hpp"
#include "grabbers/simulate/ray_caster.hpp"

namespace crisp {
namespace {

using Eigen::Vector3d;

struct Views {
  int hits = 0;
  double nearest = 1e9;
  double farthest = 0;
};

Views look_around(const Scene& scene, int rays) {
  const RayCaster caster(scene);
  RandomStream random(1, "views");
  Views views;
  for (int i = 0; i < rays; ++i) {
    const Vector3d direction = Vector3d(random.normal(), random.normal(), random.normal()).normalized();
    const auto hit = caster.cast({Vector3d::Zero(), direction}, 1000);
    if (!hit) continue;
    ++views.hits;
    views.nearest = std::min(views.nearest, hit->distance);
    views.farthest = std::max(views.farthest, hit->distance);
  }
  return views;
}

TEST(Scenes, OfficeAndHallAreClosedAndOfTheirSize) {
  constexpr int kRays = 50'000;
  const auto in_office = look_around(office(), kRays);
  EXPECT_EQ(in_office.hits, kRays);
  EXPECT_GT(in_office.nearest, 0.5) << "the scanner stands free";
  EXPECT_LT(in_office.farthest, std::hypot(10, 8, 3));
  const auto in_hall = look_around(hall(), kRays);
  EXPECT_EQ(in_hall.hits, kRays);
  EXPECT_GT(in_hall.nearest, 0.5);
  EXPECT_LT(in_hall.farthest, std::hypot(30, 20, 8));
  EXPECT_GT(in_hall.farthest, 12);
}

TEST(Scenes, TheStreetIsOpenAboveAndReachesBeyondFiftyMetres) {
  const Scene scene = street();
  const auto views = look_around(scene, 50'000);
  EXPECT_LT(views.hits, 50'000);
  EXPECT_GT(views.hits, 25'000);
  EXPECT_GT(views.nearest, 0.5);
  EXPECT_GT(views.farthest, 50);
  const RayCaster caster(scene);
  EXPECT_FALSE(caster.cast({Vector3d::Zero(), {0, 0, 1}}, 1000));
  const auto down = caster.cast({Vector3d::Zero(), {0, 0, -1}}, 1000);
  ASSERT_TRUE(down);
  EXPECT_EQ(scene.surfaces[down->surface].name, "road");
}

}  // namespace
}  // namespace crisp
