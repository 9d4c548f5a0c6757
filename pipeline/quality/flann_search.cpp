// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <flann/flann.hpp>
#include <limits>

#include "pipeline/quality/searches.hpp"

namespace crisp::quality {
namespace {

class FlannIndex final : public NeighbourIndex {
 public:
  FlannIndex(const PointsView& points, double radius) : points_(points), radius2_(radius * radius) {
    if (points.size() == 0) return;
    coordinates_ = coordinates(0, points.size());
    tree_ = std::make_unique<Tree>(flann::Matrix<double>(coordinates_.data(), points.size(), 3),
                                   flann::KDTreeSingleIndexParams());
    tree_->buildIndex();
  }

  void near(std::size_t first, std::size_t last, Neighbours& result) const override {
    result = {.begin = {0}};
    if (first == last) return;
    // Unlimited checks, exact, unsorted. The radius is squared, and single: a little too large, to be put
    // right.
    flann::SearchParams all(flann::FLANN_CHECKS_UNLIMITED, 0, false);
    all.max_neighbors = -1;
    const float enough = std::nextafter(static_cast<float>(radius2_), std::numeric_limits<float>::infinity());
    std::vector<std::vector<std::size_t>> lists;
    std::vector<std::vector<double>> distances;
    auto queries = coordinates(first, last);
    tree_->radiusSearch(flann::Matrix<double>(queries.data(), last - first, 3), lists, distances, enough,
                        all);
    for (auto& list : lists) {
      const std::size_t i = first + result.begin.size() - 1;
      std::ranges::sort(list);
      for (const std::size_t j : list) {
        const double distance2 = squared_distance(points_, i, j);
        if (distance2 >= radius2_) continue;
        result.index.push_back(static_cast<std::uint32_t>(j));
        result.squared_distance.push_back(distance2);
      }
      result.begin.push_back(result.index.size());
    }
  }

 private:
  using Tree = flann::KDTreeSingleIndex<flann::L2_Simple<double>>;

  /// FLANN's matrices are never const, so that it gets a copy.
  std::vector<double> coordinates(std::size_t first, std::size_t last) const {
    std::vector<double> result;
    result.reserve(3 * (last - first));
    for (std::size_t i = first; i < last; ++i) {
      result.insert(result.end(), {points_.x[i], points_.y[i], points_.z[i]});
    }
    return result;
  }

  PointsView points_;
  double radius2_;
  std::vector<double> coordinates_;  // which the tree does not own
  std::unique_ptr<Tree> tree_;
};

}  // namespace

std::unique_ptr<NeighbourIndex> FlannSearch::index(const PointsView& points, double radius) const {
  return std::make_unique<FlannIndex>(points, radius);
}

}  // namespace crisp::quality
