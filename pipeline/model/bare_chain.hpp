// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

#include "pipeline/data/plate_trajectory.hpp"

// Plain data only: what is behind is compiled once for each kind of processor.
namespace crisp::simd {

/// How far the points' arrays must be writable beyond the last beam.
inline constexpr std::size_t kBeyond = 8;

/// Measurements of one laser.
struct BareBeams {
  const float* range;   ///< [m]
  const float* mirror;  ///< [rad] θ
  const double* time;   ///< [s since the epoch] hub time
  std::size_t size;
};

/// The parameters of equation (2), as the chain of one laser without terms takes them.
struct BareLaser {
  double lambda;     ///< [rad] λ
  double tau;        ///< [m] τ
  double cos_alpha;  ///< of α
  double sin_alpha;
  double eta;  ///< [s] η
};

/// Equation (2) with (3) for the leading beams that were fired while the plate went along `arc`: what trace()
/// in chain.hpp makes of them, to rounding.
/// @return how many beams these are: from the next on, x, y and z hold nothing
std::size_t place_bare(const BareBeams& beams, const BareLaser& laser, const PlateArc& arc, double* x,
                       double* y, double* z);

/// Sine and cosine of n angles [rad], those inside, for the tests.
void sine_cosine(const double* angle, std::size_t n, double* sine, double* cosine);

}  // namespace crisp::simd
