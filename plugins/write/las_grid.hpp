// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <optional>

namespace crisp::write {

/// Extent of points along x, y and z [m].
struct Extent {
  std::array<double, 3> least{}, most{};

  static Extent of(const std::array<double, 3>& point) { return {point, point}; }
  void include(const std::array<double, 3>& point) {
    for (std::size_t i = 0; i < point.size(); ++i) {
      least[i] = std::min(least[i], point[i]);
      most[i] = std::max(most[i], point[i]);
    }
  }
};

/// The coordinates that a LAS file can hold: offset + scale · a whole number of 32 bits.
struct LasGrid {
  double scale = 1e-4;             ///< [m]
  std::array<double, 3> offset{};  ///< [m]

  /// [m] from the offset to the farthest coordinate.
  double reach() const { return scale * std::numeric_limits<std::int32_t>::max(); }
  /// The nearest whole numbers; nothing where a coordinate is beyond reach.
  std::optional<std::array<std::int32_t, 3>> numbers(const std::array<double, 3>& point) const;
  /// [m] The coordinate along axis i that a whole number stands for.
  double coordinate(std::size_t i, std::int32_t number) const { return offset[i] + scale * number; }
};

/// The grid of 0.1 mm around a file's first point.
LasGrid grid_near(const std::array<double, 3>& point);

/// A grid about the middle of an extent, with room for more: the scale is that of `grid`, or tenfold as often
/// as necessary. Nothing if the extent is too large for a scale of 1 m.
std::optional<LasGrid> wider_grid(const LasGrid& grid, const Extent& extent);

}  // namespace crisp::write
