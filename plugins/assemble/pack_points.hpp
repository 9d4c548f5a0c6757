// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>

#include <crisp/cloud.hpp>

// Plain data only: what is behind is compiled once for each kind of processor.
namespace crisp::simd {

/// Components of points, array by array.
struct PointArrays {
  const double* x;  ///< [m]
  const double* y;  ///< [m]
  const double* z;  ///< [m]
  const float* intensity;
  const std::uint16_t* laser;
  const std::uint16_t* beam;
  const double* time;  ///< [s since the epoch]
  std::size_t size;
};

/// Writes all fields of the points from `to` on.
void pack_points(const PointArrays& from, Point* to);

}  // namespace crisp::simd
