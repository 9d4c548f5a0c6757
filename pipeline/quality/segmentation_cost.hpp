// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

// Plain pointers only: what is behind is compiled once for each kind of processor.
namespace crisp::simd {

/// Running sums where runs may begin, a column each: those of LineSums, in its order.
struct LineColumns {
  const double* sums[6];  ///< xx, xy, yy, x, y, one
  const double* price;    ///< of all before
};

/// One of several runs that end at the same place.
struct CheapestRun {
  std::size_t beginning;  ///< the first, among equals
  double cost;
};

/// price[k] + what a line leaves of the points from k on to here, for each of n ≥ 1 beginnings.
///
/// @param here  the running sums where the runs end
/// @return      the least of these costs
CheapestRun run_costs(const LineColumns& beginnings, const double (&here)[6], std::size_t n, double* cost);

/// Whether points are seen in one direction, to a millionth of a radian: a line across it is taken then.
inline constexpr double kOneDirection = 1e-12;  // least determinant, in units of xx yy

}  // namespace crisp::simd
