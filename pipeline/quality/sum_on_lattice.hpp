// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>

#include <crisp/neighbour_search.hpp>
#include <crisp/points.hpp>

#include "pipeline/quality/truncation_bound.hpp"

namespace crisp::quality {

/// The sums of all pairs at a cost that does not grow with their number, for wide kernels: weights are spread
/// over a lattice of step 0.4 σ by quintic B-splines, convolved there with what makes a Gaussian of them (an
/// optimal influence function, as in particle–mesh methods), and read at each point by the same splines. The
/// kernel is not cut and not lowered (kernel.floor is not used), and no pairs are counted. The gradient is
/// exactly that of the value.
///
/// @param weights  one a point, about 1
GaussianSums sum_on_lattice(const PointsView& points, std::span<const double> weights,
                            const TruncatedGaussian& kernel, bool gradient);

/// Bound of the error of a pair's G / G(0).
inline constexpr double kLatticeError = 2.5e-6;

/// Whether the lattice would be faster than the pairs: an estimate from how the points lie, the same for the
/// same points on any machine.
bool lattice_pays(const PointsView& points, const TruncatedGaussian& kernel);

}  // namespace crisp::quality
