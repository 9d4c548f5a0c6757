// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <unordered_set>

namespace crisp {

/// The cells of a cubic grid in which a point has been.
class Voxels {
 public:
  /// @param size [m] of a cell's edge, > 0
  explicit Voxels(double size) : size_(size) {}

  /// Whether no point before was in this one's cell, [x, x + size) and so on from the origin. A point that is
  /// not a number, or more than 2^31 cells away, is never the first.
  bool is_first(float x, float y, float z);

 private:
  using Cell = std::array<std::int32_t, 3>;
  struct Hash {
    std::size_t operator()(const Cell& cell) const;
  };

  double size_;
  std::unordered_set<Cell, Hash> taken_;
};

}  // namespace crisp
