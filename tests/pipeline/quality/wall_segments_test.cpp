// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/quality/wall_segments.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include <crisp/error.hpp>

#include "tests/pipeline/quality/clouds.hpp"

namespace crisp {
namespace {

using namespace crisp::quality;

/// Beams from the origin, and which wall each met.
struct Slice {
  Vectors points, directions;
  std::vector<int> wall;

  BeamsView beams() const { return {points.view(), directions.view(), {}}; }
  void add_beam(double azimuth, double range, int met) {
    test::add(points, range * std::cos(azimuth), range * std::sin(azimuth), 0);
    test::add(directions, std::cos(azimuth), std::sin(azimuth), 0);
    wall.push_back(met);
  }
};

/// A square room of 6 m, with a window of 1 m that lies 10 cm deep in the wall at x = 3.
Slice room_with_window(unsigned seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> noise(0, 0.012);
  std::uniform_real_distribution<double> all_round(-M_PI, M_PI);
  Slice slice;
  for (int k = 0; k < 1500; ++k) {
    const double azimuth = all_round(random);
    const double cosine = std::cos(azimuth);
    const double sine = std::sin(azimuth);
    const bool in_window = cosine > 0 && std::abs(3.1 * sine / cosine - 1) < 0.5;
    const int wall = in_window                           ? 4
                     : std::abs(cosine) > std::abs(sine) ? (cosine > 0 ? 0 : 2)
                                                         : (sine > 0 ? 1 : 3);
    const double range = (in_window ? 3.1 : 3) / std::max(std::abs(cosine), std::abs(sine));
    slice.add_beam(azimuth, range + noise(random), wall);
  }
  return slice;
}

TEST(WallSegments, AreTheWallsThatBeamsMet) {
  const Slice slice = room_with_window(1);
  const Surfels found = wall_lines(slice.beams(), {});
  ASSERT_EQ(found.surfels.size(), 5U)
      << "the wall on both sides of the window is one, and so is that at ±180°";
  std::size_t right = 0;
  for (const Surfel& surfel : found.surfels) {
    const auto members = found.beams_of(surfel);
    EXPECT_TRUE(std::ranges::is_sorted(members));
    const int wall = slice.wall[members[members.size() / 2]];
    right += static_cast<std::size_t>(
        std::ranges::count_if(members, [&](std::uint32_t i) { return slice.wall[i] == wall; }));
    const double azimuth = wall == 4 ? 0 : wall * M_PI / 2;
    const Eigen::Vector3d inwards(-std::cos(azimuth), -std::sin(azimuth), 0);
    EXPECT_NEAR(surfel.normal.dot(inwards), 1, 1e-4) << wall;
    // 12 mm over the square root of 55 beams at least, four times; a wall is somewhat nearer than its window
    EXPECT_NEAR(surfel.middle.dot(inwards), wall == 4 ? -3.1 : -3, 0.007) << wall;
    EXPECT_NEAR(surfel.thickness, 0.011, 0.004) << wall;
    EXPECT_NEAR(surfel.u.cross(surfel.v).dot(surfel.normal), 1, 1e-12);
  }
  EXPECT_GT(found.members.size(), 1480U);
  // In corners and at the window's edges a beam may be taken for one of the next wall.
  EXPECT_GE(right + 10, found.members.size());
  EXPECT_EQ(found.weights.size(), found.members.size());
}

TEST(WallSegments, AreNotSeenInLeaves) {
  std::size_t walls = 0;
  for (unsigned seed = 1; seed <= 10; ++seed) {
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> depth(4, 5.5);
    std::uniform_real_distribution<double> all_round(-M_PI, M_PI);
    Slice leaves;
    for (int k = 0; k < 1500; ++k) leaves.add_beam(all_round(random), depth(random), 0);
    walls += wall_lines(leaves.beams(), {}).surfels.size();
  }
  EXPECT_EQ(walls, 0U);
}

TEST(WallSegments, OfAStationaryPlateAreNone) {
  std::mt19937_64 random(1);
  std::normal_distribution<double> noise(0, 0.012);
  Slice slice;
  for (int k = 0; k < 100; ++k) slice.add_beam(0.7, 4 + noise(random), 0);
  const Surfels found = wall_lines(slice.beams(), {});
  EXPECT_TRUE(found.surfels.empty()) << "one spot";
  EXPECT_TRUE(found.members.empty());
}

TEST(WallSegments, OfFewBeamsAreNone) {
  Slice slice;
  EXPECT_TRUE(wall_lines(slice.beams(), {}).surfels.empty());
  for (int k = 0; k < 4; ++k) slice.add_beam(0.1 * k, 3 / std::cos(0.1 * k), 0);
  EXPECT_TRUE(wall_lines(slice.beams(), {}).surfels.empty());
  slice.add_beam(0.4, 3 / std::cos(0.4), 0);
  EXPECT_EQ(wall_lines(slice.beams(), {}).surfels.size(), 1U);
}

TEST(WallSegments, RefusePointsThatAreNone) {
  Slice slice;
  slice.add_beam(0, std::numeric_limits<double>::quiet_NaN(), 0);
  EXPECT_THROW(wall_lines(slice.beams(), {}), Error);
}

}  // namespace
}  // namespace crisp
