// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// The steps of find_surfels().

#include <cstddef>
#include <cstdint>
#include <vector>

#include "pipeline/quality/plane.hpp"
#include "pipeline/quality/spatial_order.hpp"
#include "pipeline/quality/surfels.hpp"
#include "pipeline/quality/vector_at.hpp"

namespace crisp::quality {

/// The occupied cells of the smallest size, along the Morton curve: cells of any larger size are runs of
/// them.
struct SurfelCells {
  SpatialOrder order;
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();  ///< [m] to which moments and planes here relate
  std::vector<std::uint64_t> key;
  std::vector<std::uint32_t> begin;  ///< its first place in the order; one more than cells
  std::vector<Moments> moments;

  std::size_t size() const { return key.size(); }
  /// End of a beam, relative to the origin.
  Eigen::Vector3d point(const BeamsView& beams, std::uint32_t beam) const {
    return vector_at(beams.points, beam) - origin;
  }
};

SurfelCells cells_of(const BeamsView& beams, const SurfelSettings& settings);

/// A flat run of cells.
struct FlatPatch {
  std::size_t first_cell = 0;
  std::size_t last_cell = 0;  ///< one past
  Moments moments;
  Plane plane;
};

/// The largest cells that are flat, judged by the shape that each view by itself sees.
std::vector<FlatPatch> flat_patches(const BeamsView& beams, const SurfelCells& cells,
                                    const SurfelSettings& settings);

/// Flat pieces that go on in one another.
struct FlatRegion {
  std::vector<std::size_t> patches;
  Moments moments;
  Plane plane;
};

/// Joins pieces, from the one with the most points on, while they keep to the plane of what is joined
/// already, and each view by itself sees one plane.
std::vector<FlatRegion> joined(const std::vector<FlatPatch>& patches, const BeamsView& beams,
                               const SurfelCells& cells, const SurfelSettings& settings);

/// The region of each beam: the one near which it ends and whose cells it meets, if it is near no other.
inline constexpr std::uint32_t kNoRegion = ~std::uint32_t{0};
std::vector<std::uint32_t> region_of_beams(const BeamsView& beams, const SurfelCells& cells,
                                           const std::vector<FlatPatch>& patches,
                                           const std::vector<FlatRegion>& regions,
                                           const SurfelSettings& settings);

/// Cells to find by their key.
class CellFinder {
 public:
  explicit CellFinder(const SurfelCells& cells);
  /// The occupied cells among the 27 about this one, itself included.
  std::vector<std::size_t> around(std::size_t cell) const;
  std::size_t find(std::uint64_t key) const;  ///< cells.size() if there is none

 private:
  const SurfelCells& cells_;
};

}  // namespace crisp::quality
