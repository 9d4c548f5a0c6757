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

/// The bottom of the valley in which `start` lies: Brent's method (1973) within `step` to either side, and
/// on from there while the curve still falls where the search ends.
///
/// @param step         > 0: a typical width of valleys
/// @param lower,upper  borders, which are not crossed; start is between them
Bottom bottom(const Curve& curve, double start, double step, double lower, double upper);

}  // namespace crisp
