// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/simulate/ray_caster.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include <crisp/error.hpp>

#include "grabbers/simulate/scenes.hpp"
#include "grabbers/simulate/shapes.hpp"
#include "pipeline/statistics/random_stream.hpp"
#include "tests/grabbers/simulate/random_direction.hpp"

namespace crisp {
namespace {

using namespace crisp::simulate;
using namespace crisp::statistics;
using Eigen::Vector3d;

/// Möller and Trumbore's ray against a triangle; infinity for a miss.
double hit_triangle(const Ray& ray, const Vector3d& a, const Vector3d& b, const Vector3d& c) {
  const Vector3d p = ray.direction.cross(c - a);
  const double det = (b - a).dot(p);
  const Vector3d t = ray.origin - a;
  const double u = t.dot(p) / det;
  const Vector3d q = t.cross(b - a);
  const double v = ray.direction.dot(q) / det;
  const double distance = (c - a).dot(q) / det;
  const bool hit = u >= 0 && v >= 0 && u + v <= 1 && distance > 0;
  return hit ? distance : std::numeric_limits<double>::infinity();
}

/// All the built-in scenes' surfaces are convex: a fan of triangles each.
double hit_all(const Ray& ray, const Scene& scene) {
  double nearest = std::numeric_limits<double>::infinity();
  for (const auto& surface : scene.surfaces) {
    for (std::size_t i = 2; i < surface.corners.size(); ++i) {
      nearest = std::min(nearest,
                         hit_triangle(ray, surface.corners[0], surface.corners[i - 1], surface.corners[i]));
    }
  }
  return nearest;
}

TEST(RayCaster, AgreesWithEveryTriangleTriedInTurn) {
  for (const auto& scene : {office(), hall(), street()}) {
    const RayCaster caster(scene);
    RandomStream random(1, scene.name);
    for (int i = 0; i < 5000; ++i) {
      const Ray ray{Vector3d{random.uniform(-0.3, 0.3), random.uniform(-0.3, 0.3), random.uniform(-0.3, 0.3)},
                    test::random_direction(random)};
      const double expected = hit_all(ray, scene);
      const auto hit = caster.cast(ray, 1000);
      ASSERT_EQ(hit.has_value(), std::isfinite(expected)) << scene.name << " " << ray.direction.transpose();
      if (hit) {
        ASSERT_NEAR(hit->distance, expected, 1e-9) << scene.name;
      }
    }
  }
}

TEST(RayCaster, ReportsIncidenceAndSurfaceOfAHandWorkedHit) {
  const Scene scene{"two walls",
                    {rectangle("far", {5, -1, -1}, {0, 2, 0}, {0, 0, 2}, 0.5),
                     rectangle("near", {2, -1, -1}, {0, 2, 0}, {0, 0, 2}, 0.5)}};
  const RayCaster caster(scene);
  const Vector3d direction = Vector3d(4, 3, 0) / 5;
  const auto hit = caster.cast({{0, -1.2, 0}, direction}, 50);  // meets x = 2 at y = 0.3
  ASSERT_TRUE(hit);
  EXPECT_EQ(scene.surfaces[hit->surface].name, "near");
  EXPECT_NEAR(hit->distance, 2.5, 1e-12);
  EXPECT_NEAR(hit->cos_incidence, 0.8, 1e-12);
  EXPECT_FALSE(caster.cast({{0, -1.2, 0}, direction}, 2.4)) << "beyond its reach";
  EXPECT_FALSE(caster.cast({{0, 0, 0}, {-1, 0, 0}}, 50)) << "behind";
}

TEST(RayCaster, MissesTheNotchOfAPolygonThatIsNotConvex) {
  const Scene scene{"L", {{"L", {{0, 0, 1}, {2, 0, 1}, {2, 1, 1}, {1, 1, 1}, {1, 2, 1}, {0, 2, 1}}, 0.5}}};
  const RayCaster caster(scene);
  EXPECT_TRUE(caster.cast({{0.5, 1.5, 0}, {0, 0, 1}}, 50));
  EXPECT_FALSE(caster.cast({{1.5, 1.5, 0}, {0, 0, 1}}, 50));
  EXPECT_NEAR(caster.distance({1.5, 1.5, 1}), 0.5, 1e-12);
  EXPECT_NEAR(caster.distance({0.5, 1.5, 3}), 2, 1e-12);
}

TEST(RayCaster, MeasuresHandWorkedDistancesToFaceEdgeAndCorner) {
  const RayCaster caster(Scene{"box", box("box", {0, 0, 0}, {1, 1, 1}, 0.5)});
  EXPECT_NEAR(caster.distance({0.5, 0.5, 3}), 2, 1e-12);
  EXPECT_NEAR(caster.distance({0.5, 4, 5}), 5, 1e-12);
  EXPECT_NEAR(caster.distance({2, 3, 3}), 3, 1e-12);
  EXPECT_NEAR(caster.distance({0.5, 0.9, 0.5}), 0.1, 1e-12) << "from inside";
  EXPECT_EQ(RayCaster(Scene{}).distance({0, 0, 0}), std::numeric_limits<double>::infinity());
}

TEST(RayCaster, FindsTheNearestOfAllSurfaces) {
  for (const auto& scene : {office(), hall(), street()}) {
    const RayCaster all(scene);
    RandomStream random(2, scene.name);
    for (int i = 0; i < 100; ++i) {
      const Vector3d point{random.uniform(-6, 6), random.uniform(-6, 6), random.uniform(-2, 4)};
      double nearest = std::numeric_limits<double>::infinity();
      for (const auto& surface : scene.surfaces) {
        nearest = std::min(nearest, RayCaster(Scene{"one", {surface}}).distance(point));
      }
      ASSERT_NEAR(all.distance(point), nearest, 1e-12);
    }
  }
}

/// A ball of 1 m at x = 5, and a wall behind it.
Scene ball_and_wall(double depth, const Walk& walk = {}) {
  return {.name = "ball",
          .surfaces = {rectangle("wall", {8, -9, -9}, {0, 18, 0}, {0, 0, 18}, 0.5)},
          .bodies = {{.name = "ball",
                      .shape = Ellipsoid{.middle = {5, 0, 0}, .radii = {1, 1, 1}},
                      .depth = depth,
                      .walk = walk}}};
}

TEST(RayCaster, MeetsRoundBodies) {
  const Scene scene = ball_and_wall(0);
  const RayCaster caster(scene);
  const auto front = caster.cast({{0, 0, 0}, {1, 0, 0}}, 50);
  ASSERT_TRUE(front);
  EXPECT_EQ(scene.name_of(front->surface), "ball");
  EXPECT_NEAR(front->distance, 4, 1e-12);
  EXPECT_NEAR(front->cos_incidence, 1, 1e-12);
  const auto oblique = caster.cast({{0, 0.6, 0}, {1, 0, 0}}, 50);  // 0.8 m before the middle
  EXPECT_NEAR(oblique->distance, 4.2, 1e-12);
  EXPECT_NEAR(oblique->cos_incidence, 0.8, 1e-12);
  EXPECT_EQ(scene.name_of(caster.cast({{0, 1.1, 0}, {1, 0, 0}}, 50)->surface), "wall") << "past it";
  EXPECT_NEAR(caster.cast({{5, 0, 0}, {0, 1, 0}}, 50)->distance, 1, 1e-12) << "from inside";
  EXPECT_NEAR(caster.distance({3, 0, 0}), 1, 1e-9);
  EXPECT_NEAR(caster.distance({7.5, 0, 0}), 0.5, 1e-9) << "the wall is nearer";
}

TEST(RayCaster, EndsInFoliageAtExponentialDepthsOrBehindIt) {
  const Scene scene = ball_and_wall(0.7);
  const RayCaster caster(scene);
  RandomStream chance(1, "leaves");
  constexpr int kShots = 20'000;
  int ended_inside = 0;
  int before_half = 0;
  for (int i = 0; i < kShots; ++i) {
    const auto hit = caster.cast({{0, 0, 0}, {1, 0, 0}}, 50, {.time = 0, .chance = &chance});
    ASSERT_TRUE(hit);
    if (scene.name_of(hit->surface) == "wall") {
      ASSERT_NEAR(hit->distance, 8, 1e-12);
      continue;
    }
    ASSERT_GT(hit->distance, 4);
    ASSERT_LT(hit->distance, 6);
    ++ended_inside;
    before_half += hit->distance < 4.5 ? 1 : 0;
  }
  // Beer and Lambert: e^(−2 m / 0.7 m) get through, e^(−0.5 m / 0.7 m) beyond half a metre; five standard
  // errors.
  EXPECT_NEAR(ended_inside, kShots * (1 - std::exp(-2 / 0.7)), 5 * std::sqrt(kShots * 0.06));
  EXPECT_NEAR(before_half, kShots * (1 - std::exp(-0.5 / 0.7)), 5 * std::sqrt(kShots * 0.25));
  EXPECT_EQ(caster.distance({5, 0, 0}), 0) << "inside";
  EXPECT_NEAR(caster.distance({3, 0, 0}), 1, 1e-9);
}

TEST(RayCaster, MeetsWhatWalksWhereItIsJustThen) {
  const Scene scene = ball_and_wall(0, {.along = {{0, 0, 0}, {0, 3, 0}, {-1, 3, 0}}, .speed = 2});
  const RayCaster caster(scene);
  const auto towards = [&](double y, double time) {
    return caster.cast({{0, y, 0}, {1, 0, 0}}, 50, {.time = time})->distance;
  };
  EXPECT_NEAR(towards(0, 0), 4, 1e-12);
  EXPECT_NEAR(towards(0, 1), 8, 1e-12) << "it has gone 2 m to the side";
  EXPECT_NEAR(towards(2, 1), 4, 1e-12);
  EXPECT_NEAR(towards(3, 2), 3, 1e-12) << "and then 1 m towards us";
  EXPECT_NEAR(towards(0, 4), 4, 1e-12) << "and back";
  EXPECT_NEAR(caster.distance({5, 0, 0}), 3, 1e-9) << "what walks is nowhere";
}

TEST(RayCaster, RefusesSurfacesThatAreNotFlatPolygons) {
  EXPECT_THROW(RayCaster(Scene{"", {{"line", {{0, 0, 0}, {1, 0, 0}}}}}), Error);
  EXPECT_THROW(RayCaster(Scene{"", {{"no area", {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}}}}), Error);
  EXPECT_THROW(RayCaster(Scene{"", {{"bent", {{0, 0, 0}, {1, 0, 0}, {1, 1, 0.01}, {0, 1, 0}}}}}), Error);
  EXPECT_THROW(
      RayCaster(Scene{.name = "", .bodies = {{"flat", Ellipsoid{.middle = {0, 0, 0}, .radii = {1, 1, 0}}}}}),
      Error);
}

}  // namespace
}  // namespace crisp
