// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/quality/line_segmentation.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "pipeline/quality/segmentation_cost.hpp"
#include "tests/support/instruction_sets.hpp"

namespace crisp {
namespace {

using namespace crisp::quality;

constexpr double kSigma = 0.012;

std::vector<LineSums> running_sums(const std::vector<Eigen::Vector2d>& points) {
  std::vector<LineSums> running(1);
  for (const auto& p : points) running.push_back(running.back() + LineSums::of(p.x(), p.y(), kSigma));
  return running;
}

/// A square of 6 m with an alcove of half a metre in one side, seen from its middle: 1.5° apart, with noise
/// along the beams and some that end anywhere.
std::vector<Eigen::Vector2d> room(unsigned seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> noise(0, kSigma);
  std::uniform_real_distribution<double> any(0, 1);
  std::vector<Eigen::Vector2d> points;
  for (int k = 0; k < 240; ++k) {
    const double azimuth = (k + 0.3) * M_PI / 120;
    const Eigen::Vector2d direction(std::cos(azimuth), std::sin(azimuth));
    const bool in_alcove = direction.x() > 0 && std::abs(direction.y()) < 0.2 * direction.x();
    double range = (in_alcove ? 3.5 : 3) / direction.cwiseAbs().maxCoeff() + noise(random);
    if (any(random) < 0.05) range *= any(random);
    points.emplace_back(range * direction);
  }
  return points;
}

/// The least price of all ways to cut, without any pruning.
double least_price(const std::vector<LineSums>& running, const RunPrices& prices) {
  std::vector<double> least(1, 0);
  for (std::size_t end = 1; end < running.size(); ++end) {
    double best = least[end - 1] + prices.outlier;
    for (std::size_t begin = 0; begin < end; ++begin) {
      best = std::min(best, least[begin] + prices.run + (running[end] - running[begin]).left());
    }
    least.push_back(best);
  }
  return least.back();
}

TEST(LineSums, GiveTheLineAndWhatIsLeftOfIt) {
  // The wall x = 2, and one beam along the x axis that is 36 mm too long: three standard deviations.
  LineSums sums;
  for (int k = -500; k <= 500; ++k) sums = sums + LineSums::of(2, 0.002 * k, kSigma);
  EXPECT_NEAR((sums.line() - Eigen::Vector2d(0.5, 0)).norm(), 0, 1e-9);
  EXPECT_NEAR(sums.left(), 0, 1e-3);
  const LineSums more = sums + LineSums::of(2.036, 0, kSigma);
  EXPECT_NEAR(more.left(), 9, 9 * 0.04) << "a thousandth less, as it moves the line; 2 % a range longer";
  EXPECT_NEAR(((more - sums).line() - Eigen::Vector2d(1 / 2.036, 0)).norm(), 0, 1e-6);
}

TEST(LineSums, OfOneDirectionAreOfALineAcrossIt) {
  LineSums sums;
  for (const double range : {2.988, 3.0, 3.012}) sums = sums + LineSums::of(0.6 * range, 0.8 * range, kSigma);
  EXPECT_NEAR((sums.line() - Eigen::Vector2d(0.2, 0.8 / 3)).norm(), 0, 2e-5) << "(noise / range)² of it";
  EXPECT_NEAR(sums.left(), 2, 0.02);
}

TEST(LineSegmentation, AreTheCheapestOfAll) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    const auto running = running_sums(room(seed));
    for (const RunPrices prices : {RunPrices{}, RunPrices{.run = 5, .outlier = 3}}) {
      const auto runs = straight_runs(running, prices);
      const double least = least_price(running, prices);
      EXPECT_NEAR(price_of(runs, running, prices), least, 1e-6 * least) << seed;
    }
  }
}

TEST(LineSegmentation, EndWhereWallsDo) {
  // The wall of the alcove is left of and right of it: six runs in all, and one that begins the panorama.
  std::vector<Eigen::Vector2d> clean;
  for (int k = 0; k < 240; ++k) {
    const double azimuth = (k + 0.3) * M_PI / 120;
    const Eigen::Vector2d direction(std::cos(azimuth), std::sin(azimuth));
    const bool in_alcove = direction.x() > 0 && std::abs(direction.y()) < 0.2 * direction.x();
    clean.emplace_back((in_alcove ? 3.5 : 3) / direction.cwiseAbs().maxCoeff() * direction);
  }
  const auto runs = straight_runs(running_sums(clean), {});
  ASSERT_EQ(runs.size(), 7U);
  const std::vector<std::size_t> ends = {8, 30, 90, 150, 210, 233, 240};
  for (std::size_t k = 0; k < runs.size(); ++k) {
    EXPECT_EQ(runs[k].begin, k == 0 ? 0 : ends[k - 1]);
    EXPECT_EQ(runs[k].end, ends[k]);
  }
}

TEST(LineSegmentation, OfNothingAreNone) {
  EXPECT_TRUE(straight_runs({}, {}).empty());
  EXPECT_TRUE(straight_runs(std::vector<LineSums>(1), {}).empty());
  EXPECT_TRUE(straight_runs(running_sums({{1, 0}}), {}).empty()) << "an outlier is cheaper";
}

class SegmentationCost : public test::EachInstructionSet {};

INSTANTIATE_TEST_SUITE_P(All, SegmentationCost, testing::ValuesIn(test::instruction_sets()),
                         test::name_of_instruction_set);

TEST_P(SegmentationCost, AreThoseOfEachBeginningByItself) {
  const auto running = running_sums(room(3));
  const LineSums here = running.back();
  for (std::size_t n = 1; n <= 19; ++n) {  // vectors, and what is left of them
    std::array<std::vector<double>, 7> columns;
    for (std::size_t k = 0; k < n; ++k) {
      const LineSums& s = running[200 + k];
      const std::array<double, 7> row = {s.xx, s.xy, s.yy, s.x, s.y, s.one, 0.1 * static_cast<double>(k)};
      for (std::size_t c = 0; c < 7; ++c) columns[c].push_back(row[c]);
    }
    std::vector<double> costs(n);
    const auto [cheapest, least] =
        simd::run_costs({{columns[0].data(), columns[1].data(), columns[2].data(), columns[3].data(),
                          columns[4].data(), columns[5].data()},
                         columns[6].data()},
                        {here.xx, here.xy, here.yy, here.x, here.y, here.one}, n, costs.data());
    EXPECT_EQ(least, std::ranges::min(costs));
    EXPECT_EQ(cheapest, static_cast<std::size_t>(std::ranges::find(costs, least) - costs.begin()));
    for (std::size_t k = 0; k < n; ++k) {
      const LineSums sums = here - running[200 + k];
      double left = 0;  // each point's own
      const Eigen::Vector2d m = sums.line();
      const auto points = room(3);
      for (std::size_t i = 200 + k; i < points.size(); ++i) {
        left += std::pow((m.dot(points[i]) - 1) * points[i].norm() / kSigma, 2);
      }
      EXPECT_NEAR(costs[k], left + 0.1 * static_cast<double>(k), 1e-5 * left + 1e-4) << n << " " << k;
    }
  }
}

TEST(LineSegmentation, CostWhatTheyLeaveAndTheirPrices) {
  // Ten spots on the wall x = 3, and one before it, of which the azimuth is the least.
  std::vector<Eigen::Vector2d> wall = {{1, -2}};
  for (int k = 0; k < 10; ++k) wall.emplace_back(3, 0.1 * k);
  const auto running = running_sums(wall);
  const RunPrices prices{.run = 25, .outlier = 9};
  EXPECT_NEAR(price_of({{1, 11}}, running, prices), 25 + 9, 1e-6);
  EXPECT_NEAR(price_of({}, running, prices), 11 * 9, 1e-9);
  EXPECT_NEAR(price_of({{0, 11}}, running, prices), 25 + running.back().left(), 1e-9);
}

TEST(LineSegmentation, GoByAzimuth) {
  const std::vector<double> x = {0, 1, 0, -1, 1};
  const std::vector<double> y = {1, 0, -1, -1, 0};
  const std::vector<double> z(5, 0);
  const PointsView points{.x = x, .y = y, .z = z};
  const std::vector<std::uint32_t> order = by_azimuth(points);
  EXPECT_EQ(order, (std::vector<std::uint32_t>{3, 2, 1, 4, 0})) << "from −π on, equal ones as they come";
  const auto running = quality::running_sums(points, order, kSigma);
  ASSERT_EQ(running.size(), 6U);
  EXPECT_EQ(running[0].one, 0);
  const LineSums first = LineSums::of(-1, -1, kSigma);
  EXPECT_EQ(running[1].xy, first.xy);
}

}  // namespace
}  // namespace crisp
