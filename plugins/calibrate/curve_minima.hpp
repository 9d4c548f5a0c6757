// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <vector>

namespace crisp::calibrate {

/// A function of one number. Where it is costly it may be a smooth one of several widths: see bottom().
using Curve = std::function<double(double)>;

/// Places on an even grid at which a curve is lower than at both neighbours, the lowest first.
///
/// @param circular  whether the grid's last place is next to its first
std::vector<double> local_minima(const Curve& curve, const std::vector<double>& grid, bool circular);

struct LineMinimum {
  double at = 0;
  double value = 0;
};

struct LineSearch {
  double start = 0;  ///< between the borders
  double step = 1;   ///< > 0: a typical width of local minima
  double lower = 0;  ///< borders, which are not crossed
  double upper = 0;
  double accuracy = 1e-3;  ///< of the step
};

/// The local minimum next to the start: Brent's method (1973) within a step to either side, extended while
/// the curve still falls where the search ends.
LineMinimum bottom(const Curve& curve, const LineSearch& search);

}  // namespace crisp::calibrate
