// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/simulate/ray_caster.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "grabbers/simulate/random.hpp"
#include "grabbers/simulate/scenes.hpp"
#include "grabbers/simulate/shapes.hpp"
#include "pipeline/data/error.hpp"

namespace crisp {
namespace {

using Eigen::Vector3d;

Vector3d random_direction(RandomStream& random) {
  return Vector3d(random.normal(), random.normal(), random.normal()).normalized();
}

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
      const Ray ray{Vector3d(random.uniform(-0.3, 0.3), random.uniform(-0.3, 0.3), random.uniform(-0.3, 0.3)),
                    random_direction(random)};
      const double expected = hit_all(ray, scene);
      const auto hit = caster.cast(ray, 1000);
      ASSERT_EQ(hit.has_value(), std::isfinite(expected)) << scene.name << " " << ray.direction.transpose();
      if (hit) {
        ASSERT_NEAR(hit->distance, expected, 1e-9) << scene.name;
      }
    }
  }
}

TEST(RayCaster, TellsIncidenceAndSurfaceOfAHandWorkedHit) {
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
      const Vector3d point(random.uniform(-6, 6), random.uniform(-6, 6), random.uniform(-2, 4));
      double nearest = std::numeric_limits<double>::infinity();
      for (const auto& surface : scene.surfaces) {
        nearest = std::min(nearest, RayCaster(Scene{"one", {surface}}).distance(point));
      }
      ASSERT_NEAR(all.distance(point), nearest, 1e-12);
    }
  }
}

TEST(RayCaster, RefusesSurfacesThatAreNotFlatPolygons) {
  EXPECT_THROW(RayCaster(Scene{"", {{"line", {{0, 0, 0}, {1, 0, 0}}}}}), Error);
  EXPECT_THROW(RayCaster(Scene{"", {{"no area", {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}}}}), Error);
  EXPECT_THROW(RayCaster(Scene{"", {{"bent", {{0, 0, 0}, {1, 0, 0}, {1, 1, 0.01}, {0, 1, 0}}}}}), Error);
}

}  // namespace
}  // namespace crisp
