// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/estimate/surface_association.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>

namespace crisp {
namespace {

using namespace crisp::estimate;
using namespace crisp::quality;

/// Beams from the origin at two walls that meet in the line x = 2, y = 2, with their noise of 12 mm.
struct Corner {
  Vectors points, directions;
  std::vector<std::uint32_t> wall;  ///< 0: x = 2 or its like, 1: y = 2

  BeamsView beams() const { return {.points = points.view(), .directions = directions.view(), .views = {}}; }
};

/// @param range  of a beam in the direction (x, y, 0): to wall 0 and to wall 1
Corner corner(const std::function<std::pair<double, std::uint32_t>(const Eigen::Vector3d&)>& range) {
  Corner corner;
  std::mt19937_64 random(1);
  std::normal_distribution<double> noise(0, 0.012);
  for (int i = 0; i < 4000; ++i) {
    const double angle = M_PI * (0.05 + 0.4 * i / 4000);  // 9° to 81°
    const double slope = 0.1 * std::sin(1.0 * i * i);
    const Eigen::Vector3d flat(std::cos(angle), std::sin(angle), 0);
    const Eigen::Vector3d direction = (flat + Eigen::Vector3d(0, 0, slope)).normalized();
    const auto [distance, wall] = range(flat);
    const Eigen::Vector3d end = (distance / direction.head<2>().norm() + noise(random)) * direction;
    for (auto [to, from] : {std::pair(&corner.points, end), {&corner.directions, direction}}) {
      to->x.push_back(from.x());
      to->y.push_back(from.y());
      to->z.push_back(from.z());
    }
    corner.wall.push_back(wall);
  }
  return corner;
}

/// Into the corner: the nearer of x = 2 and y = 2.
std::pair<double, std::uint32_t> into(const Eigen::Vector3d& d) {
  return d.x() > d.y() ? std::pair(2 / d.x(), 0U) : std::pair(2 / d.y(), 1U);
}

/// Onto an edge at (2, 2) whose faces recede: x + 4 y = 10 to the left of it and 4 x + y = 10 below.
std::pair<double, std::uint32_t> onto(const Eigen::Vector3d& d) {
  return d.x() > d.y() ? std::pair(10 / (1.5 * d.x() + 3.5 * d.y()), 0U)
                       : std::pair(10 / (3.5 * d.x() + 1.5 * d.y()), 1U);
}

void expect_each_with_its_wall(const Corner& corner) {
  const SurfelSettings settings{.smallest = 0.5};
  const Surfels found = find_surfels(corner.beams(), settings);
  ASSERT_EQ(found.surfels.size(), 2U);
  const Surfels all = associate_with_surfaces(found, corner.beams(), settings);
  ASSERT_EQ(all.surfels.size(), 2U);
  EXPECT_GT(all.members.size(), found.members.size());
  // A beam's noise is beyond 4.7 standard deviations once in 400 000.
  EXPECT_GE(all.members.size(), corner.wall.size() - 2);
  EXPECT_EQ(all.weights, std::vector<double>(all.members.size(), 1.0));
  std::size_t wrong = 0;
  for (const Surfel& surfel : all.surfels) {
    const std::uint32_t wall = corner.wall[all.beams_of(surfel)[surfel.end - surfel.begin > 1000 ? 1000 : 0]];
    for (const auto i : all.beams_of(surfel)) wrong += corner.wall[i] != wall ? 1 : 0;
  }
  EXPECT_LE(wrong, 4U);  // those within a millimetre or two of the corner, of 4000 on 4 m
}

TEST(Associations, GiveBeamsIntoACornerToTheWallThatTheyMeetFirst) {
  expect_each_with_its_wall(corner(into));
}

TEST(Associations, GiveBeamsOntoAnEdgeToTheFaceThatTheyMeetLast) { expect_each_with_its_wall(corner(onto)); }

TEST(Associations, LeaveBeamsThatEndElsewhereAlone) {
  Corner scan = corner(into);
  const SurfelSettings settings{.smallest = 0.5};
  const Surfels found = find_surfels(scan.beams(), settings);
  std::mt19937_64 random(2);
  std::uniform_real_distribution<double> shorter(0.5, 0.9);
  for (std::size_t i = 0; i < scan.points.size(); i += 10) {  // leaves, for example, before the walls
    const double by = shorter(random);
    for (auto* axis : {&scan.points.x, &scan.points.y, &scan.points.z}) (*axis)[i] *= by;
  }
  const Surfels all = associate_with_surfaces(found, scan.beams(), settings);
  EXPECT_TRUE(std::ranges::none_of(all.members, [](auto i) { return i % 10 == 0; }));
  EXPECT_GE(all.members.size(), 3590U);
}

/// Beams half a metre apart onto a front of 16 × 4 m that is 20 m away; from y = 4 on it stands back by 0.3
/// m. A surfel was found in the 63 beams in its middle.
struct Front {
  Vectors points, directions;
  Surfels found;
  std::uint32_t forward = 0;  ///< beams on what does not stand back

  Front() {
    std::mt19937_64 random(3);
    std::normal_distribution<double> noise(0, 0.012);
    for (double y = -8; y <= 8; y += 0.5) {
      for (double z = -2; z <= 2; z += 0.5) {
        const Eigen::Vector3d meets(y < 4 ? 20 : 20.3, y, z);
        const Eigen::Vector3d end = meets + noise(random) * meets.normalized();
        if (std::abs(y) < 1.6) found.members.push_back(static_cast<std::uint32_t>(points.x.size()));
        if (y < 4) ++forward;
        for (auto [to, from] :
             {std::pair(&points, end), {&directions, Eigen::Vector3d(meets.normalized())}}) {
          to->x.push_back(from.x());
          to->y.push_back(from.y());
          to->z.push_back(from.z());
        }
      }
    }
    found.surfels.push_back({.middle = {20, 0, 0},
                             .normal = {-1, 0, 0},
                             .u = {0, 1, 0},
                             .v = {0, 0, 1},
                             .radius = 1,
                             .thickness = 0.012,
                             .end = static_cast<std::uint32_t>(found.members.size())});
    found.weights.assign(found.members.size(), 1);
  }
  BeamsView beams() const { return {.points = points.view(), .directions = directions.view(), .views = {}}; }
};

TEST(Associations, GrowOverAFrontOfFewBeamsToWhereItEnds) {
  const Front front;
  const Surfels all = grow_surfaces(front.found, front.beams(), {}, {.margin = 0.25, .spacings = 4});
  ASSERT_EQ(all.surfels.size(), 1U);
  EXPECT_EQ(all.members.size(), front.forward);
  EXPECT_TRUE(std::ranges::all_of(all.members, [&](auto i) { return front.points.y[i] < 4; }));
  EXPECT_EQ(all.weights, std::vector<double>(all.members.size(), 1.0));
}

TEST(Associations, DoNotGrowWhereTheNextBeamIsTooFar) {
  const Front front;
  const Surfels all = grow_surfaces(front.found, front.beams(), {}, {.margin = 0.25, .spacings = 0.5});
  EXPECT_EQ(all.members, front.found.members);
}

TEST(Associations, OfNothingAreNothing) {
  EXPECT_TRUE(associate_with_surfaces({}, {}, {}).surfels.empty());
  EXPECT_TRUE(grow_surfaces({}, {}, {}, {}).surfels.empty());
}

}  // namespace
}  // namespace crisp
