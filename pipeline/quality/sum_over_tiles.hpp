// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>

#include <crisp/neighbour_search.hpp>
#include <crisp/points.hpp>

#include "pipeline/quality/tiles.hpp"
#include "pipeline/quality/truncation_bound.hpp"

namespace crisp::quality {

/// The sums in single precision, vectorised and in parallel, each pair once for both of its points where
/// that pays. An offset errs by some 1e-7 of the radius, a pair's kernel by some 1e-6 at the radius and less
/// within; sums of many have smaller relative errors.
///
/// @param tiles    with a reach of the kernel's radius, and refreshed for these points
/// @param weights  one a point, about 1
GaussianSums sum_over_tiles(const Tiles& tiles, const PointsView& points, std::span<const double> weights,
                            const TruncatedGaussian& kernel, bool gradient);

}  // namespace crisp::quality
