// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/filters/filter.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <pcl/impl/pcl_base.hpp>  // the definitions too: PCL compiles them for its own points only
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

/// As pcl::VoxelGrid, but keeps the first point of each voxel as it is, with all its fields (a mean of points
/// has no time, no laser and no beam), and the order of the points.
///
///     crisp::FirstInVoxel<pcl::PointXYZI> thin;
///     thin.setLeafSize(0.05);
///     thin.setInputCloud(cloud);
///     thin.filter(thinned);
template <class PointT>
class FirstInVoxel : public pcl::Filter<PointT> {
 public:
  FirstInVoxel() { this->filter_name_ = "FirstInVoxel"; }

  /// @param size [m] of a voxel's edge
  /// @throws Error unless it is a number above 0
  void setLeafSize(double size) {
    [[maybe_unused]] const Voxels checked(size);
    size_ = size;
  }
  /// [m] Edge of a voxel.
  double getLeafSize() const { return size_; }

  /// Number of points without a voxel that the last filter() dropped: they are no numbers, or 2^31 voxels or
  /// more from the origin.
  std::size_t getTooFar() const { return too_far_; }

 protected:
  /// Called by filter(). @param output  receives the points that are kept
  void applyFilter(pcl::PointCloud<PointT>& output) override {
    Voxels voxels(size_);
    output.clear();
    too_far_ = 0;
    for (const auto index : *this->indices_) {
      const PointT& point = (*this->input_)[index];
      const InVoxel found = voxels.put(point.x, point.y, point.z);
      if (found == InVoxel::first) output.push_back(point);
      if (found == InVoxel::too_far || found == InVoxel::nowhere) ++too_far_;
    }
    output.header = this->input_->header;
  }

 private:
  double size_ = 0.05;
  std::size_t too_far_ = 0;
};

}  // namespace crisp
