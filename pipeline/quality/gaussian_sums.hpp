// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <span>

#include "pipeline/quality/kernel.hpp"
#include "pipeline/quality/points.hpp"
#include "pipeline/quality/tiles.hpp"

namespace crisp {

/// What a cloud's entropy is made of: sums over the pairs of points nearer than a kernel's radius R.
struct GaussianSums {
  double kernel = 0;  ///< Σᵢ Σⱼ wᵢ wⱼ (G(xᵢ − xⱼ) − G(R)) / G(0), over ordered pairs and i = j
  Vectors pull;  ///< of point i: wᵢ Σⱼ wⱼ G(xᵢ − xⱼ)/G(0) · (xᵢ − xⱼ) [m]; empty: unwanted
  std::uint64_t pairs = 0;   ///< i < j
  std::uint64_t tested = 0;  ///< distances computed to find them
};

/// The sums in single precision, vectorised and in parallel, each pair once for both of its points where
/// that pays. An offset errs by some 1e-7 of the radius, a pair's kernel by some 1e-6 at the radius and less
/// within; of sums of many, less remains.
///
/// @param tiles    with a reach of the kernel's radius, and refreshed for these points
/// @param weights  one a point, about 1
GaussianSums sum_over_tiles(const Tiles& tiles, const PointsView& points, std::span<const double> weights,
                            const TruncatedGaussian& kernel, bool gradient);

}  // namespace crisp
