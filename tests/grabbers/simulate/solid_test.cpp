// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/simulate/solid.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include <crisp/error.hpp>

#include "pipeline/statistics/random_stream.hpp"
#include "tests/grabbers/simulate/random_direction.hpp"

namespace crisp {
namespace {

using namespace crisp::simulate;
using namespace crisp::statistics;
using Eigen::Vector3d;

constexpr double kYaw = 0.4;

/// A solid, and when a point is inside, from its definition.
struct Known {
  const char* name;
  Solid solid;
  bool (*inside)(const Vector3d&);
};

Vector3d own(const Vector3d& point, const Vector3d& middle) {
  const Vector3d p = point - middle;
  return {std::cos(kYaw) * p.x() + std::sin(kYaw) * p.y(), -std::sin(kYaw) * p.x() + std::cos(kYaw) * p.y(),
          p.z()};
}

const std::vector<Known>& all_kinds() {
  static const std::vector<Known> kinds = {
      {"cylinder", Cylinder{.from = {1, 0, 0}, .to = {1, 2, 2}, .radius = 0.5},
       [](const Vector3d& p) {
         const Vector3d axis = Vector3d(0, 1, 1) / std::numbers::sqrt2;
         const double along = axis.dot(p - Vector3d(1, 0, 0));
         return along > 0 && along < 2 * std::numbers::sqrt2 &&
                axis.cross(p - Vector3d(1, 0, 0)).norm() < 0.5;
       }},
      {"ellipsoid", Ellipsoid{.middle = {0.5, 0.2, 0}, .radii = {1.5, 0.6, 0.9}, .yaw = kYaw},
       [](const Vector3d& p) {
         const Vector3d q = own(p, {0.5, 0.2, 0});
         return std::pow(q.x() / 1.5, 2) + std::pow(q.y() / 0.6, 2) + std::pow(q.z() / 0.9, 2) < 1;
       }},
      {"block", Block{.middle = {-0.5, 0, 0.3}, .half = {1.2, 0.4, 0.7}, .yaw = kYaw}, [](const Vector3d& p) {
         const Vector3d q = own(p, {-0.5, 0, 0.3});
         return std::abs(q.x()) < 1.2 && std::abs(q.y()) < 0.4 && std::abs(q.z()) < 0.7;
       }}};
  return kinds;
}

Vector3d random_point(RandomStream& random) {
  return {random.uniform(-3, 3), random.uniform(-3, 3), random.uniform(-3, 3)};
}

TEST(Solid, IsPassedWhereItsInsideIs) {
  for (const Known& known : all_kinds()) {
    RandomStream random(1, known.name);
    int met = 0;
    for (int i = 0; i < 2000; ++i) {
      const Ray ray{.origin = random_point(random), .direction = test::random_direction(random)};
      const auto through = passage(known.solid, ray);
      for (int k = 0; k < 40; ++k) {
        const double at = random.uniform(-5, 5);
        const bool expected = known.inside(ray.origin + at * ray.direction);
        const bool printed = through && at > through->in && at < through->out;
        ASSERT_EQ(printed, expected) << known.name << " at " << at;
        met += expected ? 1 : 0;
      }
      ASSERT_EQ(is_inside(known.solid, ray.origin), known.inside(ray.origin)) << known.name;
    }
    EXPECT_GT(met, 500) << known.name;
  }
}

TEST(Solid, IsAsFarAsTheNearestOfManyPointsOfItsSurface) {
  for (const Known& known : all_kinds()) {
    RandomStream random(2, known.name);
    const Vector3d middle = bounds(known.solid).center();
    std::vector<Vector3d> surface;
    for (int i = 0; i < 40'000; ++i) {
      const Ray ray{.origin = middle, .direction = test::random_direction(random)};
      const auto through = passage(known.solid, ray);
      ASSERT_TRUE(through);
      surface.emplace_back(ray.origin + through->out * ray.direction);
      EXPECT_TRUE(bounds(known.solid).exteriorDistance(surface.back()) < 1e-9);
      EXPECT_NEAR(distance_to_surface(known.solid, surface.back()), 0, 1e-6);
    }
    for (int i = 0; i < 50; ++i) {
      const Vector3d point = random_point(random);
      double nearest = std::numeric_limits<double>::infinity();
      for (const auto& p : surface) nearest = std::min(nearest, (p - point).norm());
      const double printed = distance_to_surface(known.solid, point);
      EXPECT_LE(printed, nearest + 1e-9) << known.name << " " << point.transpose();
      // Points of the surface are some 2 cm apart, 5 cm at its far ends.
      EXPECT_GT(printed, nearest - (nearest < 0.2 ? 0.08 : 0.02)) << known.name << " " << point.transpose();
    }
  }
}

TEST(Solid, KnowsHandWorkedDistances) {
  const Solid sphere = Ellipsoid{.middle = {1, 0, 0}, .radii = {2, 2, 2}};
  EXPECT_NEAR(distance_to_surface(sphere, {1, 0, 0}), 2, 1e-9) << "from the middle";
  EXPECT_NEAR(distance_to_surface(sphere, {4, 4, 0}), 3, 1e-9);
  const Solid disc = Ellipsoid{.middle = {0, 0, 0}, .radii = {3, 2, 1}};
  EXPECT_NEAR(distance_to_surface(disc, {0, 0, 0}), 1, 1e-9) << "along the shortest";
  EXPECT_NEAR(distance_to_surface(disc, {5, 0, 0}), 2, 1e-9);
  const Solid bar = Cylinder{.from = {0, 0, 0}, .to = {0, 0, 4}, .radius = 1};
  EXPECT_NEAR(distance_to_surface(bar, {0, 0, 1.5}), 1, 1e-12) << "to the side";
  EXPECT_NEAR(distance_to_surface(bar, {0, 0, 3.9}), 0.1, 1e-12) << "to the end";
  EXPECT_NEAR(distance_to_surface(bar, {4, 0, 8}), 5, 1e-12) << "to the rim";
  const Solid cube = Block{.middle = {0, 0, 0}, .half = {1, 1, 1}};
  EXPECT_NEAR(distance_to_surface(cube, {3, 3, 2}), 3, 1e-12) << "to the corner";
}

TEST(Solid, HasItsNormalAlongTheGradientOfTheDistance) {
  for (const Known& known : all_kinds()) {
    RandomStream random(3, known.name);
    const Vector3d middle = bounds(known.solid).center();
    for (int i = 0; i < 200; ++i) {
      const Vector3d direction = test::random_direction(random);
      const Vector3d point =
          middle + passage(known.solid, {.origin = middle, .direction = direction})->out * direction;
      const Vector3d normal = normal_at(known.solid, point);
      constexpr double kStep = 1e-4;
      EXPECT_NEAR(distance_to_surface(known.solid, point + kStep * normal), kStep, 1e-6) << known.name;
      EXPECT_FALSE(is_inside(known.solid, point + kStep * normal)) << known.name;
    }
  }
}

TEST(Solid, IsTheSameElsewhere) {
  for (const Known& known : all_kinds()) {
    RandomStream random(4, known.name);
    const Solid moved = placed(known.solid, 0.7, {1, -2, 0.5}, 1.5);
    for (int i = 0; i < 200; ++i) {
      const Vector3d point = random_point(random);
      const Vector3d there = 1.5 * (Eigen::AngleAxisd(0.7, Vector3d::UnitZ()) * point) + Vector3d(1, -2, 0.5);
      EXPECT_NEAR(distance_to_surface(moved, there), 1.5 * distance_to_surface(known.solid, point), 1e-6);
    }
  }
}

TEST(Solid, IsRefusedWithoutAVolume) {
  EXPECT_THROW(check(Cylinder{.from = {0, 0, 0}, .to = {0, 0, 0}, .radius = 1}, "flat"), Error);
  EXPECT_THROW(check(Ellipsoid{.middle = {0, 0, 0}, .radii = {1, 0, 1}}, "flat"), Error);
  EXPECT_THROW(check(Block{.middle = {0, 0, 0}, .half = {1, 1, -1}}, "inside out"), Error);
  EXPECT_NO_THROW(check(Block{.middle = {0, 0, 0}, .half = {1, 1, 1}}, "cube"));
}

}  // namespace
}  // namespace crisp
