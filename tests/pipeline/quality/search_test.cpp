// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <crisp/error.hpp>
#include <crisp/neighbour_search.hpp>
#include <crisp/rqe.hpp>

#include "tests/pipeline/quality/awkward_clouds.hpp"

namespace crisp {
namespace {

SearchRegistry built_in() {
  SearchRegistry registry;
  register_built_in(registry);
  return registry;
}

Neighbours near_all(const std::string& search, const Vectors& cloud, double radius) {
  Neighbours result;
  const auto points = cloud.view();
  built_in().make(search)->index(points, radius)->near(0, cloud.size(), result);
  return result;
}

TEST(Search, ListsTheNeighboursOfAHandWorkedLine) {
  const Vectors line{{0, 1, 2.5}, {0, 0, 0}, {0, 0, 0}};
  for (const auto& name : built_in().names()) {
    const auto near = near_all(name, line, 1.5);  // 1 and 2.5 are just too far apart
    EXPECT_THAT(near.begin, testing::ElementsAre(0, 2, 4, 5)) << name;
    EXPECT_THAT(near.index, testing::ElementsAre(0, 1, 0, 1, 2)) << name;
    EXPECT_THAT(near.squared_distance, testing::ElementsAre(0, 1, 1, 0, 0)) << name;
  }
}

TEST(Search, FindsTheSameNeighboursInEveryWay) {
  for (const auto& [what, cloud] : test::awkward_clouds()) {
    const auto exact = near_all("exact", cloud, 0.1);
    for (const auto& name : built_in().names()) {
      const auto near = near_all(name, cloud, 0.1);
      EXPECT_EQ(near.begin, exact.begin) << name << ", " << what;
      EXPECT_EQ(near.index, exact.index) << name << ", " << what;
      EXPECT_EQ(near.squared_distance, exact.squared_distance) << name << ", " << what;
    }
  }
}

TEST(Search, ListsARunOfPointsAsItListsAll) {
  const auto cloud = test::room_corner(300, 1, 0.005, 12);
  const auto points = cloud.view();
  for (const auto& name : built_in().names()) {
    const auto all = near_all(name, cloud, 0.2);
    Neighbours some;
    built_in().make(name)->index(points, 0.2)->near(100, 102, some);
    const std::vector<std::uint32_t> expected(
        all.index.begin() + static_cast<std::ptrdiff_t>(all.begin[100]),
        all.index.begin() + static_cast<std::ptrdiff_t>(all.begin[102]));
    EXPECT_EQ(some.index, expected) << name;
    EXPECT_EQ(some.begin.size(), 3U) << name;
  }
}

TEST(Search, OfNoPointsListsNone) {
  for (const auto& name : built_in().names())
    EXPECT_THAT(near_all(name, {}, 1).begin, testing::ElementsAre(0));
}

TEST(Search, GivesTheSameEntropyInEveryWay) {
  // "exact" and "flann" sum in double precision, "grid" in single: some 1e-7 a pair.
  for (const auto& [what, cloud] : test::awkward_clouds()) {
    const auto weights = test::random_weights(cloud.size(), 13);
    const auto exact = built_in().make("exact");
    const auto truth = rqe(cloud.view(), weights, {.sigma = 0.02}, *exact);
    const double at_the_radius = test::pairs_between(cloud, 7 * 0.02 * (1 - 1e-6), 7 * 0.02 * (1 + 1e-6));
    double largest = 1 / 0.02;  // a gradient of about 1/σ a point is what a close pair makes
    for (const double g : truth.gradient.x) largest = std::max(largest, std::abs(g));
    for (const auto& name : built_in().names()) {
      const auto search = built_in().make(name);
      const auto result = rqe(cloud.view(), weights, {.sigma = 0.02}, *search);
      const double tolerance = name == "grid" ? 1e-6 : 1e-12;
      EXPECT_NEAR(result.value, truth.value, tolerance) << name << ", " << what;
      EXPECT_NEAR(static_cast<double>(result.pairs), static_cast<double>(truth.pairs), at_the_radius)
          << name << ", " << what;
      for (std::size_t i = 0; i < cloud.size(); ++i) {
        EXPECT_NEAR(result.gradient.x[i], truth.gradient.x[i], tolerance * largest) << name << ", " << what;
        EXPECT_NEAR(result.gradient.z[i], truth.gradient.z[i], tolerance * largest) << name << ", " << what;
      }
    }
  }
}

TEST(Search, UsedAgainForPointsThatMovedMeasuresThemAsIfForTheFirstTime) {
  for (const auto& name : built_in().names()) {
    auto cloud = test::room_corner(900, 1, 0.005, 14);
    const auto search = built_in().make(name);
    std::mt19937_64 random(15);
    for (const double step : {0.0, 0.001, 0.01, 0.1, 1.0}) {  // of little account, and beyond all recognition
      std::normal_distribution<double> move(0, step);
      for (auto* axis : {&cloud.x, &cloud.y, &cloud.z}) {
        for (double& x : *axis) x += move(random);
      }
      const auto again = rqe(cloud.view(), {}, {.sigma = 0.02}, *search);
      const auto fresh = rqe(cloud.view(), {}, {.sigma = 0.02}, *built_in().make("exact"));
      EXPECT_NEAR(again.value, fresh.value, 1e-6) << name << ", " << step;
      EXPECT_NEAR(again.gradient.y[5], fresh.gradient.y[5], 1e-4) << name << ", " << step;
    }
    // Another radius, and another number of points.
    EXPECT_NEAR(rqe(cloud.view(), {}, {.sigma = 0.2}, *search).value,
                rqe(cloud.view(), {}, {.sigma = 0.2}).value, 1e-6);
    test::add(cloud, 0, 0, 0);
    EXPECT_NEAR(rqe(cloud.view(), {}, {.sigma = 0.2}, *search).value,
                rqe(cloud.view(), {}, {.sigma = 0.2}).value, 1e-6);
  }
}

TEST(Search, RefusesNamesThatAreUnknownOrTaken) {
  auto registry = built_in();
  EXPECT_THROW(registry.make("octopus"), Error);
  EXPECT_THROW(register_built_in(registry), Error);
}

}  // namespace
}  // namespace crisp
