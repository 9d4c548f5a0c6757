// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace crisp::model {

/// Covariates of a range's noise.
struct EchoConditions {
  double range = 0;      ///< [m]
  double cosine = 1;     ///< |cos β| on the surface that was met; 1: head-on
  double remission = 0;  ///< device's units
};

/// Parts that the variance of a range is the sum of, as independent causes:
///
/// - kSigma: sigma², whatever is met;
/// - kRange: (slope r)², `noise.range_dependent`;
/// - kIncidence: (spread tan β)², `noise.incidence_dependent`: a spot on a slope stretches the echo;
/// - kRemission: jitter² / I, `noise.remission_dependent`: n photons time an echo √n times better than one.
///
/// sigma, spread and jitter are in m, slope has no unit.
enum class VariancePart : std::size_t { kSigma, kRange, kIncidence, kRemission };
inline constexpr std::size_t kVarianceParts = 4;

/// One value for each part: its amplitude (sigma, slope, spread, jitter), or another property.
using ByPart = std::array<double, kVarianceParts>;

/// The variance [m²] of each part of size 1. What would be infinite is not: beams that graze count as met at
/// 84°, where tan β = 9.95, and echoes of less than one of the device's units as of one.
inline ByPart unit_variances(const EchoConditions& echo) {
  constexpr double kMinCosine = 0.1;
  constexpr double kMinRemission = 1;
  const double cosine = std::clamp(std::abs(echo.cosine), kMinCosine, 1.0);
  return {1, echo.range * echo.range, 1 / (cosine * cosine) - 1, 1 / std::max(kMinRemission, echo.remission)};
}

/// [m] Standard deviation of a range by all parts together.
inline double deviation(const ByPart& sizes, const EchoConditions& echo) {
  const ByPart units = unit_variances(echo);
  double variance = 0;
  for (std::size_t part = 0; part < kVarianceParts; ++part) {
    variance += sizes[part] * sizes[part] * units[part];
  }
  return std::sqrt(variance);
}

}  // namespace crisp::model
