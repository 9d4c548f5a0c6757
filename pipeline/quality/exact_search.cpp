// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/quality/searches.hpp"

namespace crisp::quality {
namespace {

class ExactIndex final : public NeighbourIndex {
 public:
  ExactIndex(const PointsView& points, double radius) : points_(points), radius2_(radius * radius) {}

  void near(std::size_t first, std::size_t last, Neighbours& result) const override {
    result = {.begin = {0}};
    for (std::size_t i = first; i < last; ++i) {
      for (std::size_t j = 0; j < points_.size(); ++j) {
        const double distance2 = squared_distance(points_, i, j);
        if (distance2 >= radius2_) continue;
        result.index.push_back(static_cast<std::uint32_t>(j));
        result.squared_distance.push_back(distance2);
      }
      result.begin.push_back(result.index.size());
    }
  }

 private:
  PointsView points_;
  double radius2_;
};

}  // namespace

std::unique_ptr<NeighbourIndex> ExactSearch::index(const PointsView& points, double radius) const {
  return std::make_unique<ExactIndex>(points, radius);
}

}  // namespace crisp::quality
