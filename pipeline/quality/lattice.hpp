// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <crisp/points.hpp>

namespace crisp::quality {

/// A field on a cubic lattice about some points, between whose nodes quintic B-splines interpolate.
class Lattice {
 public:
  /// Number of nodes of a lattice about these points.
  static double nodes_about(const PointsView& points, double step);

  /// A field of zeros.
  /// @param step  [m] between nodes
  Lattice(const PointsView& points, double step);

  /// Adds each point's weight to the 6³ nodes about it, by their B-splines.
  void spread(const PointsView& points, std::span<const double> weights);

  /// Convolves the field, along each axis in turn, with a symmetric kernel: half[0] in the middle, half[m] at
  /// ± m nodes.
  void convolve(std::span<const double> half);

  struct Value {
    double value = 0;
    std::array<double, 3> gradient{};  ///< [1/m]
  };
  /// The field at a point about which the lattice was made.
  Value at(double x, double y, double z) const;

 private:
  static constexpr std::size_t kSupport = 6;

  /// One coordinate's place: the first of the 6 nodes, their B-splines, and the derivatives of these [1/m].
  struct Splines {
    std::size_t first = 0;
    std::array<double, kSupport> value{};
    std::array<double, kSupport> slope{};
  };
  Splines splines(std::size_t axis, double coordinate) const;
  void spread_slab(const PointsView& points, std::span<const double> weights,
                   std::span<const std::uint32_t> members);

  // Axes in the order of memory: [0] varies slowest and is the longest, so that it can be cut for threads;
  // [1] is the shortest.
  std::array<std::size_t, 3> axis_{};
  std::array<double, 3> origin_{};
  std::array<std::size_t, 3> nodes_{};
  double step_;
  std::vector<double> field_;
};

}  // namespace crisp::quality
