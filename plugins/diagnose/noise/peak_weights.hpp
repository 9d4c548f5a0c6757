// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "plugins/diagnose/noise/noise_model.hpp"

namespace crisp::diagnose {

/// Limits of a uniform distribution of the beams' weights of the farther peak.
struct WeightLimits {
  double least = 0, most = 1;
  double least_error = 0, most_error = 0;
};

/// Estimates the limits of the uniform distribution from which the beams' weights are drawn (empirical
/// Bayes).
///
/// The likelihood of one beam's weight w uses the beam's ranges with the position of its spot as a nuisance
/// parameter. The mean of the ranges only locates the peaks by their shares in these ranges and holds no
/// further information on w. Integrating each weight over the uniform distribution from a to b, the product
/// over beams is the likelihood of a and b. Values and errors are its mean and standard deviation over 0 ≤ a
/// < b ≤ 1. For exactly known weights this mean is unbiased: it exceeds the outermost by the spacing of the
/// beams, while the maximum-likelihood limits are the outermost themselves. For uncertain weights it accounts
/// for their errors, where percentiles or extremes of the estimates would be too wide.
///
/// @param model   with two peaks, fitted to the ranges; their distance and widths are known well
/// @param errors  about the means of their beams
WeightLimits weight_limits(const NoiseModel& model, const RangeErrors& errors);

}  // namespace crisp::diagnose
