// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <unordered_set>

namespace crisp {

/// State of a point's cell in a grid.
enum class InVoxel {
  first,    ///< no point was there before
  later,    ///< another one was
  too_far,  ///< it has no cell: 2^31 of them or more from the origin
  nowhere,  ///< a coordinate is no number
};

/// The cells of a cubic grid in which a point has been.
class Voxels {
 public:
  /// @param size [m] of a cell's edge
  /// @throws Error unless it is a number above 0
  explicit Voxels(double size);

  /// Puts a point into its cell, [x, x + size) and so on from the origin.
  InVoxel put(float x, float y, float z);

 private:
  using Cell = std::array<std::int32_t, 3>;
  struct Hash {
    std::size_t operator()(const Cell& cell) const;
  };

  double size_;
  std::unordered_set<Cell, Hash> taken_;
};

}  // namespace crisp
