// SPDX-License-Identifier: BSD-3-Clause
#include <pcl/kdtree/kdtree_flann.h>
#include <pcl/point_types.h>

#include <array>
#include <cmath>
#include <nanoflann.hpp>

#include "tests/bench/rivals.hpp"

namespace crisp::bench {
namespace {

/// What nanoflann needs to know of the points.
struct CloudForNanoflann {
  const Vectors& cloud;
  std::size_t kdtree_get_point_count() const { return cloud.size(); }
  double kdtree_get_pt(std::size_t i, std::size_t axis) const {
    return axis == 0 ? cloud.x[i] : axis == 1 ? cloud.y[i] : cloud.z[i];
  }
  template <class Box>
  bool kdtree_get_bbox(Box&) const {
    return false;
  }
};

/// Adds what point j does to point i.
void add_pair(const Vectors& cloud, const TruncatedGaussian& kernel, std::size_t i, std::size_t j,
              double distance2, PairSums& sums) {
  const double g = std::exp(-kernel.exponent * distance2);
  sums.kernel += g - kernel.floor;
  sums.gradient.x[i] += g * (cloud.x[i] - cloud.x[j]);
  sums.gradient.y[i] += g * (cloud.y[i] - cloud.y[j]);
  sums.gradient.z[i] += g * (cloud.z[i] - cloud.z[j]);
}

}  // namespace

PairSums by_nanoflann(const Vectors& cloud, const TruncatedGaussian& kernel) {
  using Tree = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<double, CloudForNanoflann>,
                                                   CloudForNanoflann, 3>;
  const CloudForNanoflann adaptor{cloud};
  const Tree tree(3, adaptor);
  PairSums sums;
  sums.gradient.assign(cloud.size(), 0);
  std::vector<std::pair<std::uint32_t, double>> found;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const std::array<double, 3> at{cloud.x[i], cloud.y[i], cloud.z[i]};
    found.clear();
    tree.radiusSearch(at.data(), kernel.radius * kernel.radius, found, nanoflann::SearchParams(0, 0, false));
    for (const auto& [j, distance2] : found) add_pair(cloud, kernel, i, j, distance2, sums);
  }
  return sums;
}

PairSums by_pcl(const Vectors& cloud, const TruncatedGaussian& kernel) {
  const auto points = pcl::make_shared<pcl::PointCloud<pcl::PointXYZ>>();
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    points->emplace_back(static_cast<float>(cloud.x[i]), static_cast<float>(cloud.y[i]),
                         static_cast<float>(cloud.z[i]));
  }
  pcl::KdTreeFLANN<pcl::PointXYZ> tree(false);  // unsorted lists
  tree.setInputCloud(points);
  PairSums sums;
  sums.gradient.assign(cloud.size(), 0);
  pcl::Indices found;
  std::vector<float> distance2;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    tree.radiusSearch((*points)[i], kernel.radius, found, distance2);
    for (std::size_t k = 0; k < found.size(); ++k) {
      add_pair(cloud, kernel, i, static_cast<std::size_t>(found[k]), static_cast<double>(distance2[k]), sums);
    }
  }
  return sums;
}

}  // namespace crisp::bench
