// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>

#include "pipeline/quality/spatial_order.hpp"

namespace crisp {

/// The kernel between two points of a cloud whose points are Gaussians of width σ each: the isotropic normal
/// density of variance 2σ² in three dimensions, lowered by its value at the cut-off radius and 0 beyond.
struct TruncatedGaussian {
  TruncatedGaussian(double width, double cutoff);  ///< @throws Error unless 1e-6 ≤ σ ≤ 1e6 m, 1 ≤ cutoff ≤ 12

  double sigma = 0;     ///< [m]
  double radius = 0;    ///< [m] R
  double exponent = 0;  ///< [1/m²] 1/(4σ²): G(d) = peak · exp(−exponent · d²)
  double peak = 0;      ///< [1/m³] G(0)
  double floor = 0;     ///< G(R) / G(0)
};

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

}  // namespace crisp
