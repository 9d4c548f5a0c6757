// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <utility>

#include "pipeline/quality/searches.hpp"
#include "pipeline/quality/spatial_order.hpp"
#include "pipeline/quality/sum_on_lattice.hpp"
#include "pipeline/quality/sum_over_tiles.hpp"
#include "pipeline/quality/truncation_bound.hpp"

namespace crisp::quality {
namespace {

class GridIndex final : public NeighbourIndex {
 public:
  GridIndex(const PointsView& points, double radius)
      : points_(points), tiles_(points, radius, spatial_order(points, radius).index) {}

  void near(std::size_t first, std::size_t last, Neighbours& result) const override {
    result = {.begin = {0}};
    std::vector<std::uint32_t> tiles;
    std::vector<std::pair<std::uint32_t, double>> list;
    for (std::size_t i = first; i < last; ++i) {
      tiles_.near_tiles({points_.x[i], points_.y[i], points_.z[i]}, tiles);
      list.clear();
      for (const std::uint32_t tile : tiles) add_near(i, tile, list);
      std::ranges::sort(list);
      for (const auto& [j, distance2] : list) {
        result.index.push_back(j);
        result.squared_distance.push_back(distance2);
      }
      result.begin.push_back(result.index.size());
    }
  }

 private:
  void add_near(std::size_t i, std::uint32_t tile,
                std::vector<std::pair<std::uint32_t, double>>& list) const {
    for (std::uint32_t slot = tiles_.begin()[tile]; slot < tiles_.begin()[tile + 1]; ++slot) {
      const std::uint32_t j = tiles_.order()[slot];
      const double distance2 = squared_distance(points_, i, j);
      if (distance2 < tiles_.reach() * tiles_.reach()) list.emplace_back(j, distance2);
    }
  }

  PointsView points_;
  Tiles tiles_;
};

}  // namespace

std::unique_ptr<NeighbourIndex> GridSearch::index(const PointsView& points, double radius) const {
  return std::make_unique<GridIndex>(points, radius);
}

GaussianSums GridSearch::sums(const PointsView& points, std::span<const double> weights,
                              const TruncatedGaussian& kernel, const RequestedSums& requested) {
  if (!(last_ && last_->points == points.size() && last_->radius == kernel.radius)) {
    last_ =
        Last{.points = points.size(), .radius = kernel.radius, .on_lattice = lattice_pays(points, kernel)};
    tiles_.reset();
  }
  if (!last_->on_lattice) return over_tiles(points, weights, kernel, requested);
  GaussianSums result = sum_on_lattice(points, weights, kernel, requested.gradient);
  if (requested.error) {
    TruncatedGaussian whole = kernel;
    whole.floor = kLatticeError;
    result.error = truncation_bound(whole, spatial_order(points, kernel.radius), weights);
  }
  return result;
}

GaussianSums GridSearch::over_tiles(const PointsView& points, std::span<const double> weights,
                                    const TruncatedGaussian& kernel, const RequestedSums& requested) {
  constexpr double kMoreTests = 1.3;  // than with fresh tiles: about what sorting costs
  const bool serves =
      tiles_ && last_->tested <= kMoreTests * last_->tested_when_new && tiles_->refresh(points);
  SpatialOrder order;
  if (!serves || requested.error) order = spatial_order(points, kernel.radius);
  if (!serves) tiles_.emplace(points, kernel.radius, order.index);
  GaussianSums result = sum_over_tiles(*tiles_, points, weights, kernel, requested.gradient);
  last_->tested = static_cast<double>(result.tested);
  if (!serves) last_->tested_when_new = last_->tested;
  if (requested.error) result.error = truncation_bound(kernel, order, weights);
  return result;
}

}  // namespace crisp::quality
