// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <crisp/points.hpp>

namespace crisp::quality {

/// n boxes along the axes [m], as a struct of arrays. An empty one has low = ∞, high = −∞.
struct Boxes {
  std::array<std::vector<double>, 3> low;
  std::array<std::vector<double>, 3> high;

  explicit Boxes(std::size_t n);  ///< n empty boxes
  std::size_t size() const { return low[0].size(); }
};

/// Points in spatial order, cut into tiles of up to 16 neighbours, with a tree of boxes above them that
/// finds the tiles near a tile. The order and the cuts may outlive the positions that they were made for:
/// refresh() makes all answers exact again, wherever the points have moved; they then only cost more.
class Tiles {
 public:
  static constexpr std::size_t kCapacity = 16;  ///< points in a tile, at most
  static constexpr std::size_t kFanOut = 8;     ///< boxes below a box of the tree

  /// @param reach  [m] within which neighbours will be sought
  /// @param order  of the points, in which neighbours follow one another: that of spatial_order()
  Tiles(const PointsView& points, double reach, std::vector<std::uint32_t> order);

  /// Updates the positions of the same points.
  /// @return whether all tiles are still compact; if not, sums over them lose precision, and time is lost
  bool refresh(const PointsView& points);

  std::size_t size() const { return begin_.size() - 1; }
  std::size_t points() const { return order_.size(); }
  double reach() const { return reach_; }
  std::span<const std::uint32_t> order() const { return order_; }           ///< slot → index of the point
  std::span<const double> at(std::size_t axis) const { return at_[axis]; }  ///< [m] by slot: x, y or z
  std::span<const std::uint32_t> begin() const {
    return begin_;
  }                                                       ///< tile → its first slot; one more than tiles
  const Boxes& boxes() const { return levels_.front(); }  ///< of the tiles; then empty ones, to whole groups

  /// The boxes of kFanOut consecutive tiles each.
  std::size_t groups() const { return (size() + kFanOut - 1) / kFanOut; }
  /// Groups with a tile that may have points within the reach of a tile of this group, itself included.
  void near_groups(std::size_t group, std::vector<std::uint32_t>& near) const;
  /// Tiles that may have points within the reach of this one [m].
  void near_tiles(const std::array<double, 3>& at, std::vector<std::uint32_t>& near) const;

 private:
  void gather(const PointsView& points);
  void cut();
  std::vector<std::uint32_t> cut(std::uint32_t begin, std::uint32_t end) const;
  bool set_tile_boxes();
  struct Query;
  void near_below(std::size_t level, std::size_t box, const Query& query) const;

  double reach_;
  std::vector<std::uint32_t> order_;
  std::array<std::vector<double>, 3> at_;  // by slot: coordinates needed all over the cloud are gathered once
  std::vector<std::uint32_t> begin_;
  std::vector<Boxes> levels_;  // tiles, groups, groups of groups …; each filled up to a multiple of kFanOut
};

/// The squared distance [m²] between two boxes: of any point in one to any in the other, at least.
double squared_gap(const Boxes& a, std::size_t i, const Boxes& b, std::size_t j);

}  // namespace crisp::quality
