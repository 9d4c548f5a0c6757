// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

namespace crisp::statistics {

/// The value below which a share (0 to 1) of the values lie, which are put into another order; NaN where
/// there are none.
template <class Number>
Number quantile_in_place(std::vector<Number>& values, double share) {
  if (values.empty()) return std::numeric_limits<Number>::quiet_NaN();
  const auto place =
      values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), place, values.end());
  return *place;
}

/// The median (of an even number the upper of the two) of values, which are put into another order; NaN where
/// there are none.
template <class Number>
Number median_in_place(std::vector<Number>& values) {
  if (values.empty()) return std::numeric_limits<Number>::quiet_NaN();
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Standard deviation of what is normal about 0, in medians of its size.
inline constexpr double kMadToSigma = 1.4826;

/// Tukey's biweight of a residual, which is given as a share of the size from which it no longer counts.
inline double biweight(double share) {
  const double x = std::min(1.0, std::abs(share));
  return (1 - x * x) * (1 - x * x);
}

/// Derivative of a residual times its biweight by the residual: ψ′, by that weight.
inline double biweight_psi_derivative(double weight) {
  const double root = std::sqrt(weight);
  return root * (5 * root - 4);
}

}  // namespace crisp::statistics
