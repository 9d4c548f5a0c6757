// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "pipeline/quality/points.hpp"

namespace crisp {

/// The sums of a cloud's entropy, over the pairs of points nearer than a kernel's radius R.
struct GaussianSums {
  double kernel = 0;  ///< Σᵢ Σⱼ wᵢ wⱼ (G(xᵢ − xⱼ) − G(R)) / G(0), over ordered pairs and i = j
  Vectors gradient;  ///< of point i: wᵢ Σⱼ wⱼ G(xᵢ − xⱼ)/G(0) · (xᵢ − xⱼ) [m]; empty: unwanted
  double error = 0;          ///< `kernel` with the whole G(xᵢ − xⱼ) lies within ± error; 0: unwanted
  std::uint64_t pairs = 0;   ///< i < j; 0 where no pairs were formed
  std::uint64_t tested = 0;  ///< distances computed to find them
};

/// Sums to compute in addition to `kernel`.
struct RequestedSums {
  bool gradient = true;
  bool error = true;
};

}  // namespace crisp
