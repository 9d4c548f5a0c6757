// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/report/local_planes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace crisp {
namespace {

using namespace crisp::quality;
using namespace crisp::report;

constexpr double kCell = 0.1;  // [m]

/// A square of 0.3 m at z = 1 m, in the middle of a cell of 0.4 m, every other point `off` above and below
/// it.
Vectors square(double off) {
  Vectors points;
  for (int i = 0; i < 30; ++i) {
    for (int j = 0; j < 30; ++j) {
      points.x.push_back(0.01 * i);
      points.y.push_back(0.01 * j);
      points.z.push_back(1 + ((i + j) % 2 == 0 ? off : -off));
    }
  }
  return points;
}

TEST(LocalPlanes, GiveEachPointItsDistanceFromItsSurface) {
  const Vectors points = square(0.01);
  const LocalPlanes planes = local_planes(points.view(), spatial_order(points.view(), kCell));
  int with_plane = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double distance = planes.distance(i, points.view());
    if (std::isnan(distance)) continue;
    ++with_plane;
    EXPECT_NEAR(std::abs(distance), 0.01, 2e-3);
  }
  EXPECT_GT(with_plane, 800);
}

TEST(LocalPlanes, CountDistancesTowardsTheScanner) {
  const Vectors points = square(0.01);
  const LocalPlanes planes = local_planes(points.view(), spatial_order(points.view(), kCell));
  const std::size_t farther = 15 * 30 + 15, nearer = farther + 1;  // z is 1.01 m and 0.99 m
  EXPECT_LT(planes.distance(farther, points.view()), 0);
  EXPECT_GT(planes.distance(nearer, points.view()), 0);
}

TEST(LocalPlanes, GiveTheAngleBetweenBeamAndNormal) {
  const Vectors points = square(0);
  const LocalPlanes planes = local_planes(points.view(), spatial_order(points.view(), kCell));
  const std::size_t middle = 15 * 30 + 15;
  EXPECT_NEAR(planes.incidence(middle, {0, 0, -2}), 0, 1e-6);
  EXPECT_NEAR(planes.incidence(middle, {3, 0, 3}), std::numbers::pi / 4, 1e-6);
}

TEST(LocalPlanes, AreNoneWherePointsFillASpace) {
  Vectors points;
  for (int i = 0; i < 1000; ++i) {
    points.x.push_back(0.03 * (i % 10));
    points.y.push_back(0.03 * (i / 10 % 10));
    const int layer = i / 100;
    points.z.push_back(0.03 * layer);
  }
  const LocalPlanes planes = local_planes(points.view(), spatial_order(points.view(), kCell));
  EXPECT_TRUE(planes.planes.empty());
  EXPECT_TRUE(std::isnan(planes.distance(0, points.view())));
}

TEST(LocalPlanes, AreNoneOfAFewPoints) {
  const Vectors points{.x = {0, 0.1, 0}, .y = {0, 0, 0.1}, .z = {0, 0, 0}};
  EXPECT_TRUE(local_planes(points.view(), spatial_order(points.view(), kCell)).planes.empty());
}

}  // namespace
}  // namespace crisp
