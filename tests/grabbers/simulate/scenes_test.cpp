// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/simulate/scenes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "grabbers/simulate/ray_caster.hpp"
#include "pipeline/statistics/random_stream.hpp"
#include "tests/grabbers/simulate/random_direction.hpp"

namespace crisp {
namespace {

using namespace crisp::simulate;
using namespace crisp::statistics;
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
    const Vector3d direction = test::random_direction(random);
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

TEST(Scenes, HoldWhatRealPlacesHold) {
  const Scene workshop = built_in_scene("workshop");
  EXPECT_EQ(look_around(workshop, 20'000).hits, 20'000) << "closed";
  EXPECT_GT(look_around(workshop, 20'000).nearest, 0.5);
  const Scene people = built_in_scene("people");
  EXPECT_EQ(look_around(people, 20'000).hits, 20'000);
  EXPECT_TRUE(std::ranges::any_of(people.bodies, [](const Body& body) { return body.walk.moves(); }));

  const Scene garden = built_in_scene("garden");
  const RayCaster caster(garden);
  RandomStream random(1, "garden");
  int leaves = 0;
  int hits = 0;
  for (int i = 0; i < 20'000; ++i) {
    const Vector3d direction = test::random_direction(random);
    const auto hit = caster.cast({Vector3d::Zero(), direction}, 50, {.time = 0, .chance = &random});
    if (!hit) continue;
    ++hits;
    leaves += hit->surface >= garden.surfaces.size() &&
              garden.bodies[hit->surface - garden.surfaces.size()].depth > 0;
  }
  EXPECT_GT(hits, 10'000);
  EXPECT_GT(leaves, 0.55 * hits) << "mostly foliage";
}

}  // namespace
}  // namespace crisp
