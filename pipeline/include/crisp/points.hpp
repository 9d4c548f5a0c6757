// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace crisp {

/// A view of n points [m] in any one Cartesian frame, as a struct of arrays.
struct PointsView {
  std::span<const double> x;  ///< [m] n coordinates
  std::span<const double> y;  ///< [m] n coordinates
  std::span<const double> z;  ///< [m] n coordinates

  std::size_t size() const { return x.size(); }  ///< number of points
};

/// [m²]
inline double squared_distance(const PointsView& points, std::size_t i, std::size_t j) {
  const double x = points.x[i] - points.x[j];
  const double y = points.y[i] - points.y[j];
  const double z = points.z[i] - points.z[j];
  return x * x + y * y + z * z;
}

/// n vectors that are owned, as a struct of arrays.
struct Vectors {
  std::vector<double> x;  ///< n components
  std::vector<double> y;  ///< n components
  std::vector<double> z;  ///< n components

  std::size_t size() const { return x.size(); }  ///< number of vectors
  /// Makes it n vectors, all of whose components are `value`.
  void assign(std::size_t n, double value);
  /// A view of the vectors as points; valid until they change.
  PointsView view() const { return {x, y, z}; }
};

/// Refuses what no measure of a cloud can work with.
///
/// @throws Error  if the arrays' lengths differ, or if a coordinate is no number or beyond ±1e12 m
void check(const PointsView& points);

/// Refuses weights that do not fit the points. No weights at all stand for n ones.
///
/// @throws Error  if there are neither 0 nor n of them, if one is negative or not finite, or if all are 0
void check_weights(std::span<const double> weights, std::size_t n);

/// n weights in the same ratios, but of mean 1; for no weights, n ones.
std::vector<double> with_mean_one(std::span<const double> weights, std::size_t n);

}  // namespace crisp
