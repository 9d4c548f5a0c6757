// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/study/figures.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

#include "grabbers/simulate/paper.hpp"
#include "grabbers/simulate/ray_caster.hpp"
#include "pipeline/data/degree.hpp"
#include "plugins/study/figure_files.hpp"

namespace crisp {
namespace {

using namespace crisp::data;
using namespace crisp::simulate;
using namespace crisp::study;

const FigureSettings& settings() {
  static const FigureSettings settings;
  return settings;
}

/// All figures, computed once.
const Figures& figures() {
  static const Figures figures = [] {
    SearchRegistry searches;
    register_built_in(searches);
    MeasureRegistry measures;
    register_built_in(measures);
    return make_figures(settings(), *measures.make("rqe", {}, searches));
  }();
  return figures;
}

/// Steps at which a curve is lower than at both neighbours, ends included.
std::vector<std::size_t> local_minima(const std::vector<double>& curve) {
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < curve.size(); ++i) {
    const bool from_left = i == 0 || curve[i] < curve[i - 1];
    const bool from_right = i + 1 == curve.size() || curve[i] <= curve[i + 1];
    if (from_left && from_right) found.push_back(i);
  }
  return found;
}

std::size_t lowest(const std::vector<double>& curve) {
  return static_cast<std::size_t>(std::ranges::min_element(curve) - curve.begin());
}

/// [m] RMS distance of the points from the room's walls.
double distance_from_walls(const BeamCloud& cloud) {
  const RayCaster walls(paper_room());
  double squares = 0;
  for (const auto& point : cloud.points.colwise()) {
    squares += std::pow(walls.distance({point.x(), point.y(), 0}), 2);
  }
  return std::sqrt(squares / static_cast<double>(cloud.points.cols()));
}

TEST(Figures, FourShowsABeamsCloudFallIntoPlace) {
  EXPECT_EQ(figures().before.eta, 0);
  EXPECT_NEAR(figures().after.eta, settings().eta, 0.5e-3);
  EXPECT_GT(figures().before.points.cols(), 450);  // a beam each turn of the mirror, 10 s at 50 Hz
  // At 30 ms the plate is up to 22° further on, which is more than a metre at a wall. The noise is 12 mm at
  // most; 0.5 ms are up to 3 cm more.
  EXPECT_GT(distance_from_walls(figures().before), 0.2);
  EXPECT_LT(distance_from_walls(figures().after), 0.02);
}

TEST(Figures, FiveHasOneMinimumAndThatNearTheTruth) {
  const auto& cost = figures().surface.cost;
  const std::size_t rows = settings().tau.steps;
  const std::size_t columns = settings().alpha.steps;
  ASSERT_EQ(cost.size(), rows * columns);
  std::vector<std::size_t> minima;
  for (std::size_t i = 0; i < rows; ++i) {
    for (std::size_t j = 0; j < columns; ++j) {
      double least = cost[i * columns + j];
      for (std::size_t a = i > 0 ? i - 1 : 0; a <= std::min(i + 1, rows - 1); ++a) {
        for (std::size_t b = j > 0 ? j - 1 : 0; b <= std::min(j + 1, columns - 1); ++b) {
          least = std::min(least, cost[a * columns + b]);
        }
      }
      if (cost[i * columns + j] == least) minima.push_back(i * columns + j);
    }
  }
  ASSERT_EQ(minima.size(), 1U);
  // Steps of 12.5 mm and 1°; the bias of RQE at 0.1 m is some millimetres and tenths of a degree.
  EXPECT_NEAR(settings().tau.at(minima[0] / columns), 0.2, 0.013);
  EXPECT_NEAR(settings().alpha.at(minima[0] % columns), 0, 1.01 * kDegree);
}

TEST(Figures, SixHasItsMinimumAtTheTruthAndDeeperTheNarrowerTheKernel) {
  ASSERT_EQ(settings().widths.front(), 0.1);
  for (const auto* curves : {&figures().over_tau.cost, &figures().over_alpha.cost}) {
    const Axis& axis = curves == &figures().over_tau.cost ? settings().tau : settings().alpha;
    const double truth = curves == &figures().over_tau.cost ? 0.2 : 0;
    double depth_before = 1e9;
    for (std::size_t k = 0; k < 3; ++k) {  // up to 0.5 m; a wider kernel is wider than the bay of the room
      const auto& curve = (*curves)[k];
      EXPECT_THAT(local_minima(curve), testing::SizeIs(1)) << settings().widths[k];
      const double step = axis.at(1) - axis.at(0);
      EXPECT_NEAR(axis.at(lowest(curve)), truth, 1.01 * step) << settings().widths[k];
      const double depth = *std::ranges::max_element(curve) - *std::ranges::min_element(curve);
      EXPECT_LT(depth, depth_before) << settings().widths[k];
      depth_before = depth;
    }
  }
  const auto& optima = figures().optima;
  EXPECT_NEAR(optima.front().tau, 0.2, 0.01);
  EXPECT_NEAR(optima.front().alpha, 0, 0.5 * kDegree);
  EXPECT_GT(std::abs(optima.back().tau - 0.2), 10 * std::abs(optima.front().tau - 0.2)) << "at 2 m";
}

TEST(Figures, SevenHasItsMinimumNearTheTruthAndMoreOthersTheNarrowerTheKernel) {
  const auto& curves = figures().over_lag.cost;
  ASSERT_EQ(settings().lag_widths, (std::vector<double>{0.5, 0.04, 0.012, 0.001}));
  EXPECT_NEAR(settings().lag.at(lowest(curves[0])), settings().eta, 5e-3);  // wide: smooth, and off
  for (const std::size_t narrow : {1, 2}) {
    EXPECT_NEAR(settings().lag.at(lowest(curves[narrow])), settings().eta, 1.01e-3) << narrow;
  }
  EXPECT_EQ(local_minima(curves[0]).size(), 1U);
  for (std::size_t k = 1; k < 4; ++k)
    EXPECT_GT(local_minima(curves[k]).size(), local_minima(curves[k - 1]).size()) << k;
}

TEST(Figures, AreWrittenAsPlainColumnsUnderAHeader) {
  const auto files = figure_files(settings(), figures());
  EXPECT_EQ(files.size(), 6U);
  for (const auto& [name, text] : files) {
    EXPECT_EQ(text.front(), '#') << name;
    EXPECT_EQ(text.find("nan"), std::string::npos) << name;
    EXPECT_EQ(text.find("inf"), std::string::npos) << name;
  }
  EXPECT_EQ(std::ranges::count(files.at("fig7_eta.dat"), '\n'), 2 + 401);
  EXPECT_EQ(std::ranges::count(files.at("fig5_surface.dat"), '\n'), 2 + 41 * 42);
  EXPECT_THAT(files.at("fig6_optimum.dat"), testing::HasSubstr("\n0.1 "));
}

TEST(Figures, StopWhenInterrupted) {
  SearchRegistry searches;
  register_built_in(searches);
  MeasureRegistry measures;
  register_built_in(measures);
  const auto measure = measures.make("rqe", {}, searches);
  EXPECT_TRUE(make_figures(settings(), *measure, [] { return true; }).surface.cost.empty());
}

}  // namespace
}  // namespace crisp
