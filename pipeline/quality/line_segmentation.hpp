// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <crisp/points.hpp>

namespace crisp::quality {

/// Sums over points of a plane, from which the line that fits their distances from the origin best follows.
///
/// A line n·x = p that does not go through the origin is m·x = 1 with m = n / p. A point at the distance r
/// that lies δ before or behind the line, as seen from the origin, has m·x − 1 ≈ ∓δ / r: with a weight of
/// r² / σ² least squares in m minimizes the distances from the line in units of ranges' standard deviation σ,
/// and is linear.
struct LineSums {
  double xx = 0, xy = 0, yy = 0, x = 0, y = 0, one = 0;

  static LineSums of(double x, double y, double sigma);
  LineSums operator+(const LineSums& b) const;
  LineSums operator-(const LineSums& b) const;

  Eigen::Vector2d line() const;  ///< m [1/m]; of points in one direction the line across it
  double left() const;           ///< sum of (δ/σ)²
};

/// Indices of points in the order of their azimuth about the origin.
std::vector<std::uint32_t> by_azimuth(const PointsView& points);

/// Sums over the points before each of an order, and over all: n + 1.
std::vector<LineSums> running_sums(const PointsView& points, const std::vector<std::uint32_t>& order,
                                   double sigma);

/// Neighbours in an order: begin … end − 1.
struct Run {
  std::size_t begin = 0, end = 0;
};

/// Prices of a run and of a point outside of runs, in units of squared standard deviations.
struct RunPrices {
  double run = 25;     ///< two numbers and a border among some thousand points (BIC: 3 log n)
  double outlier = 9;  ///< as three standard deviations
};

/// Segments points into straight runs and outliers: the segmentation with the least sum of residuals and
/// prices. Exact, by dynamic programming over the ends of runs with pruning (Killick, Fearnhead, Eckley:
/// "Optimal detection of changepoints with a linear computational cost", 2012).
///
/// @param running  n + 1: sums over the points before each
/// @return         in ascending order
std::vector<Run> straight_runs(const std::vector<LineSums>& running, const RunPrices& prices);

/// The total cost of runs and outliers [σ²].
double price_of(const std::vector<Run>& runs, const std::vector<LineSums>& running, const RunPrices& prices);

}  // namespace crisp::quality
