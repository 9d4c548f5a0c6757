// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <vector>

namespace crisp {

/// A function of one number. Where it is costly it may be a smooth one of several widths: see bottom().
using Curve = std::function<double(double)>;

/// Places on an even grid at which a curve is lower than at both neighbours, the lowest first.
///
/// @param circular  whether the grid's last place is next to its first
std::vector<double> valleys(const Curve& curve, const std::vector<double>& grid, bool circular);

struct Bottom {
  double at = 0;
  double value = 0;
};

struct BottomSearch {
  double start = 0;  ///< between the borders
  double step = 1;   ///< > 0: a typical width of valleys
  double lower = 0;  ///< borders, which are not crossed
  double upper = 0;
  double accuracy = 1e-3;  ///< of the step
};

/// The bottom of the valley in which the start lies: Brent's method (1973) within a step to either side, and
/// on from there while the curve still falls where the search ends.
Bottom bottom(const Curve& curve, const BottomSearch& search);

}  // namespace crisp
