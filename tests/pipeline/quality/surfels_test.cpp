// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/quality/surfels.hpp"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <limits>

#include <crisp/error.hpp>

#include "tests/pipeline/quality/room.hpp"

namespace crisp {
namespace {

using namespace crisp::quality;

/// Beams straight down on z = height + slope · x², over a square of this side [m].
test::RoomScan look_down(std::size_t n, double side, double height, double bend, unsigned seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> place(-side / 2, side / 2);
  std::normal_distribution<double> error(0, 0.012);
  test::RoomScan scan;
  for (std::size_t i = 0; i < n; ++i) {
    const double x = place(random);
    const double y = place(random);
    test::add(scan.points, x, y, height + bend * x * x + error(random));
    test::add(scan.directions, 0, 0, -1);
  }
  return scan;
}

TEST(Surfels, KeepTheBeamsOfEachThatIsAdded) {
  Surfels surfels;
  surfels.add({.radius = 1}, std::vector<std::uint32_t>{4, 7});
  surfels.weights[0] = 0.5;
  surfels.add({.radius = 2}, std::vector<std::uint32_t>{1});
  ASSERT_EQ(surfels.surfels.size(), 2U);
  EXPECT_EQ(surfels.surfels[1].radius, 2);
  EXPECT_EQ(surfels.beams_of(surfels.surfels[0]).size(), 2U);
  EXPECT_EQ(surfels.beams_of(surfels.surfels[1]).front(), 1U);
  EXPECT_EQ(surfels.members, (std::vector<std::uint32_t>{4, 7, 1}));
  EXPECT_EQ(surfels.weights, (std::vector<double>{0.5, 1, 1}));
}

TEST(Surfels, GrowToTheWholeWallsOfARoom) {
  const auto scan = test::scan_room(30000, {{0, 0}, {0, 0}, {0, 0}}, 0.012, 1);
  const auto found = find_surfels(scan.beams(), {});
  ASSERT_GE(found.surfels.size(), 6U);
  std::vector<int> seen(6, 0);
  for (std::size_t s = 0; s < 6; ++s) {
    const Surfel& surfel = found.surfels[s];
    int axis = 0;
    surfel.normal.cwiseAbs().maxCoeff(&axis);
    // Normals point into the room, and the plane is known to the noise over the root of its beams.
    const bool low = surfel.normal[axis] > 0;
    ++seen.at(2 * static_cast<std::size_t>(axis) + (low ? 0 : 1));
    const double wall = low ? test::kRoomLow[axis] : test::kRoomHigh[axis];
    const double beams = surfel.end - surfel.begin;
    EXPECT_NEAR(surfel.middle[axis], wall, 5 * 0.012 / std::sqrt(beams));
    EXPECT_NEAR(std::abs(surfel.normal[axis]), 1, 1e-5);
    EXPECT_LT(surfel.thickness, 0.0135);
  }
  EXPECT_EQ(seen, std::vector<int>(6, 1));
  std::size_t in_walls = 0;
  for (std::size_t s = 0; s < 6; ++s) in_walls += found.surfels[s].end - found.surfels[s].begin;
  EXPECT_GT(in_walls, 0.9 * static_cast<double>(scan.points.size()));
}

TEST(Surfels, LeaveOutWhatLiesOnAFloorHoweverFlat) {
  auto scan = look_down(40000, 3, 0, 0, 4);
  std::vector<bool> on_the_mat(scan.points.size());
  for (std::size_t i = 0; i < scan.points.size(); ++i) {
    on_the_mat[i] = std::abs(scan.points.x[i] - 0.6) < 0.4 && std::abs(scan.points.y[i]) < 0.4;
    if (on_the_mat[i]) scan.points.z[i] += 0.02;  // less than two standard deviations of the noise
  }
  const auto found = find_surfels(scan.beams(), {});
  ASSERT_FALSE(found.surfels.empty());
  const Surfel& floor = found.surfels[0];
  double weight = 0;
  double of_the_mat = 0;
  for (std::uint32_t k = floor.begin; k < floor.end; ++k) {
    weight += found.weights[k];
    if (on_the_mat[found.members[k]]) of_the_mat += found.weights[k];
  }
  EXPECT_LT(of_the_mat, 0.01 * weight);  // it covers 7 % of the floor
  EXPECT_GT(weight, 0.7 * 40000);        // Tukey's weights are 0.77 on average
  const double height = floor.normal.dot(floor.middle) / floor.normal.z();  // at x = y = 0
  EXPECT_NEAR(height, 0, 5 * 0.012 / std::sqrt(40000.0));
}

TEST(Surfels, TakeNoBeamFromBothSidesOfACorner) {
  const auto scan = test::scan_room(30000, {{0, 0}, {0, 0}, {0, 0}}, 0.012, 2);
  const auto found = find_surfels(scan.beams(), {});
  for (std::size_t s = 0; s < 6; ++s) {
    const Surfel& surfel = found.surfels[s];
    for (std::uint32_t k = surfel.begin; k < surfel.end; ++k) {
      const std::uint32_t i = found.members[k];
      const Eigen::Vector3d point(scan.points.x[i], scan.points.y[i], scan.points.z[i]);
      EXPECT_LT(std::abs(surfel.normal.dot(point - surfel.middle)), 0.07);
    }
  }
}

TEST(Surfels, AreNotSplitWhereverASurfaceLiesAmongTheCells) {
  for (unsigned k = 0; k < 25; ++k) {
    // A few beams elsewhere move the cells about.
    auto scan = look_down(4000, 3, 0.01 * k, 0, k);
    for (unsigned i = 0; i < 4100 + 10 * k; ++i) {
      test::add(scan.points, 50, 50, -0.3 * i);
      test::add(scan.directions, 0, 0, -1);
    }
    const auto found = find_surfels(scan.beams(), {});
    ASSERT_EQ(found.surfels.size(), 1U) << k;
    EXPECT_GT(found.surfels[0].end - found.surfels[0].begin, 3900U) << k;
    EXPECT_NEAR(found.surfels[0].middle.z(), 0.01 * k, 5 * 0.012 / std::sqrt(4000)) << k;
  }
}

TEST(Surfels, AreFlatOnShapeHoweverMuchViewsDisagree) {
  auto scan = look_down(6000, 3, 0, 0, 3);
  for (std::size_t i = 0; i < scan.points.size(); ++i) {
    scan.views.push_back(i % 3);
    scan.points.z[i] += 0.04 * static_cast<double>(i % 3);  // three sheets
  }
  const auto found = find_surfels(scan.beams(), {});
  ASSERT_EQ(found.surfels.size(), 1U);
  EXPECT_GT(found.surfels[0].end - found.surfels[0].begin, 5900U);
  // The same beams as one view are no flat surface, but a thick one.
  scan.views.clear();
  EXPECT_EQ(find_surfels(scan.beams(), {}).surfels.size(), 0U);
}

TEST(Surfels, StaySmallOnWhatIsBent) {
  const auto bent = look_down(40000, 3, 0, 0.4, 4);  // 90 cm at the rims
  const auto found = find_surfels(bent.beams(), {});
  ASSERT_GT(found.surfels.size(), 3U);
  for (const Surfel& surfel : found.surfels) {
    EXPECT_NEAR(surfel.middle.z(), 0.4 * surfel.middle.x() * surfel.middle.x(), 0.02);
    const double slope = -surfel.normal.x() / surfel.normal.z();
    EXPECT_NEAR(slope, 0.8 * surfel.middle.x(), 0.1);
  }
}

TEST(Surfels, AreDividedAtAStepWhereViewsAreCompared) {
  constexpr double kStep = 0.025;  // [m] two standard deviations of the noise
  auto scan = look_down(40000, 12, 0, 0, 6);
  for (std::size_t i = 0; i < scan.points.size(); ++i) {
    if (scan.points.x[i] > 0) scan.points.z[i] += kStep;
  }
  const auto beams_of_largest = [&](const SurfelSettings& settings) {
    const auto found = find_surfels(scan.beams(), settings);
    return found.surfels.at(0).end - found.surfels.at(0).begin;
  };
  EXPECT_GT(beams_of_largest({}), 30000U);
  const SurfelSettings compared{.largest = 1, .max_bump = 0.5};
  EXPECT_LT(beams_of_largest(compared), 21000U);

  const auto found = find_surfels(scan.beams(), compared);
  for (std::size_t s = 0; s < 2; ++s) {
    const Surfel& side = found.surfels.at(s);
    const double beams = side.end - side.begin;
    EXPECT_GT(beams, 17000);
    EXPECT_NEAR(side.middle.z(), side.middle.x() > 0 ? kStep : 0, 5 * 0.012 / std::sqrt(beams));
  }
}

TEST(Surfels, AreNotFoundInScatter) {
  auto scan = look_down(20000, 3, 0, 0, 5);
  std::mt19937_64 random(6);
  std::uniform_real_distribution<double> place(-1.5, 1.5);
  for (double& z : scan.points.z) z = place(random);
  EXPECT_EQ(find_surfels(scan.beams(), {}).surfels.size(), 0U);
}

/// Moves every other beam of a surfel to and fro across its plane.
void roughen(test::RoomScan& scan, const Surfels& surfels, const Surfel& surfel, double by) {
  for (const std::uint32_t i : surfels.beams_of(surfel)) {
    const double step = i % 2 == 0 ? by : -by;
    scan.points.x[i] += step * surfel.normal.x();
    scan.points.y[i] += step * surfel.normal.y();
    scan.points.z[i] += step * surfel.normal.z();
  }
}

TEST(Surfels, AreLeftOutWhereBeamsMissThemByMoreThanElsewhere) {
  auto scan = test::scan_room(3000, {{0, 0}, {0, 0}, {0, 0}}, 0.012, 12);
  const SurfelSettings settings;
  auto surfels = find_surfels(scan.beams(), settings);
  const auto all = surfels.surfels.size();
  ASSERT_GT(all, 3U);
  constexpr double kMore = 1.3;
  reject_inconsistent(surfels, scan.beams(), settings, kMore);
  EXPECT_EQ(surfels.surfels.size(), all);

  const Surfel odd = surfels.surfels[2];
  roughen(scan, surfels, odd, 0.02);
  reject_inconsistent(surfels, scan.beams(), settings, kMore);
  EXPECT_EQ(surfels.surfels.size(), all - 1);
  for (const Surfel& surfel : surfels.surfels) EXPECT_NE(surfel.begin, odd.begin);

  // But a wrong calibration roughens all of them.
  for (const Surfel& surfel : surfels.surfels) roughen(scan, surfels, surfel, 0.02);
  reject_inconsistent(surfels, scan.beams(), settings, kMore);
  EXPECT_EQ(surfels.surfels.size(), all - 1);
}

TEST(Surfels, AreLeftOutWhereBeamsGrazeThem) {
  test::RoomScan scan;
  Surfels found;
  for (const double sine : {0.1, 0.3}) {  // of the angle between beams and floor
    test::add(scan.points, 1, 0, 0);
    test::add(scan.directions, std::sqrt(1 - sine * sine), 0, -sine);
    const auto beam = static_cast<std::uint32_t>(scan.points.x.size() - 1);
    found.add({.middle = {1, 0, 0}, .normal = {0, 0, 1}, .radius = sine}, std::vector<std::uint32_t>{beam});
  }
  reject_grazed(found, scan.beams());
  ASSERT_EQ(found.surfels.size(), 1U);
  EXPECT_EQ(found.surfels[0].radius, 0.3);
}

TEST(Surfels, OfNothingAreNone) {
  EXPECT_EQ(find_surfels({}, {}).surfels.size(), 0U);
  const auto few = look_down(5, 1, 0, 0, 7);
  EXPECT_EQ(find_surfels(few.beams(), {}).surfels.size(), 0U);
}

TEST(Surfels, AreTheSameOnAnyNumberOfThreads) {
  const auto scan = test::scan_room(5000, {{0, 0}, {0, 0}}, 0.012, 8);
  const auto many = find_surfels(scan.beams(), {});
  const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
  const auto one = find_surfels(scan.beams(), {});
  EXPECT_EQ(one.members, many.members);
  ASSERT_EQ(one.surfels.size(), many.surfels.size());
  for (std::size_t s = 0; s < one.surfels.size(); ++s)
    EXPECT_EQ(one.surfels[s].normal, many.surfels[s].normal);
}

TEST(Surfels, RefuseWhatCannotBe) {
  auto scan = look_down(100, 1, 0, 0, 9);
  EXPECT_THROW(find_surfels(scan.beams(), {.smallest = 0}), Error);
  EXPECT_THROW(find_surfels(scan.beams(), {.largest = 0.1}), Error);
  EXPECT_THROW(find_surfels(scan.beams(), {.noise = -1}), Error);
  scan.views = {1, 2, 3};
  EXPECT_THROW(find_surfels(scan.beams(), {}), Error);
  scan.views.clear();
  scan.points.x[3] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(find_surfels(scan.beams(), {}), Error);
}

}  // namespace
}  // namespace crisp
