// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <flann/flann.hpp>
#include <limits>

#include "pipeline/quality/searches.hpp"

namespace crisp {
namespace {

class FlannIndex final : public NeighbourIndex {
 public:
  FlannIndex(const PointsView& points, double radius) : points_(points), radius2_(radius * radius) {
    if (points.size() == 0) return;
    for (std::size_t i = 0; i < points.size(); ++i) {
      coordinates_.insert(coordinates_.end(), {points.x[i], points.y[i], points.z[i]});
    }
    tree_ = std::make_unique<Tree>(rows(0, points.size()), flann::KDTreeSingleIndexParams());
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
    tree_->radiusSearch(rows(first, last), lists, distances, enough, all);
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

  flann::Matrix<double> rows(std::size_t first, std::size_t last) const {
    // FLANN's matrices are never const; it does not write to these.
    return {const_cast<double*>(coordinates_.data()) + 3 * first, last - first, 3};
  }

  PointsView points_;
  double radius2_;
  std::vector<double> coordinates_;
  std::unique_ptr<Tree> tree_;
};

}  // namespace

std::unique_ptr<NeighbourIndex> FlannSearch::index(const PointsView& points, double radius) const {
  return std::make_unique<FlannIndex>(points, radius);
}

}  // namespace crisp
