// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>

#include <crisp/neighbour_search.hpp>

#include "pipeline/quality/spatial_order.hpp"

namespace crisp::quality {

/// Bound of the truncated part of Σᵢ Σⱼ wᵢ wⱼ G(xᵢ − xⱼ) / G(0), the sum over all pairs.
///
/// Points are sorted into cubic cells, of summed weight W each. For any two cells o apart,
/// Σ W(A) W(A + o) ≤ Σ W(A)² (Cauchy and Schwarz), and a pair in them errs by no more than G at R or at the
/// least distance of such cells, whichever is lower. Summed over all o.
///
/// @param order    of the points, by cells of the kernel's radius
/// @param weights  one a point
double truncation_bound(const TruncatedGaussian& kernel, const SpatialOrder& order,
                        std::span<const double> weights);

}  // namespace crisp::quality
