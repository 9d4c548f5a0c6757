// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "plugins/diagnose/noise_law.hpp"

namespace crisp {

/// Between what the weights of the farther of two peaks lie, if each beam's own is drawn evenly.
struct WeightLimits {
  double least = 0, most = 1;
  double least_error = 0, most_error = 0;
};

/// The limits of the even law that beams' weights are drawn from, by the likelihood of all their ranges.
///
/// What one beam says of its weight w is the likelihood of its ranges, with where it meets its spot unknown:
/// the mean of so many ranges is where the two peaks lie by their shares in *these* ranges, and says nothing
/// of w beyond that. Each beam's weight integrated over the even law from a to b, the product over beams is
/// the likelihood of a and b. Values and errors are mean and standard deviation of it over 0 ≤ a < b ≤ 1. Of
/// weights that are exactly known the mean lies as far beyond the outermost as beams are apart, which has no
/// bias (the likeliest limits are the outermost themselves); of weights that are roughly known it counts by
/// how much, where percentiles or extremes of the estimates would be those of a wider law.
///
/// @param law     with two peaks, fitted to the ranges: their distance and each one's spread are known well
/// @param errors  about the means of their beams
WeightLimits weight_limits(const NoiseLaw& law, const RangeErrors& errors);

}  // namespace crisp
