// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/cuda/unit_search.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "pipeline/quality/blocks.hpp"
#include "pipeline/quality/searches.hpp"
#include "pipeline/quality/truncation_bound.hpp"

namespace crisp::cuda {
namespace {

constexpr std::size_t kPointBlock = 65536;  // points

/// [radii] by which cells are wider than the kernel reaches: while no coordinate has moved by half of that,
/// points within the radius still are in adjacent cells.
constexpr double kSlack = 0.1;

/// Whether no coordinate is farther from where it was than `most` [m].
bool all_near(std::span<const double> now, std::span<const double> before, double most) {
  std::vector<char> near(quality::blocks_of(now.size(), kPointBlock), 1);
  quality::for_blocks(now.size(), kPointBlock, [&](std::size_t block, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      if (!(std::abs(now[i] - before[i]) <= most)) near[block] = 0;
    }
  });
  return std::ranges::all_of(near, [](char all) { return all != 0; });
}

Vectors copy_of(const PointsView& points) {
  return {{points.x.begin(), points.x.end()},
          {points.y.begin(), points.y.end()},
          {points.z.begin(), points.z.end()}};
}

}  // namespace

std::unique_ptr<NeighbourIndex> UnitSearch::index(const PointsView& points, double radius) const {
  return quality::GridSearch().index(points, radius);
}

const UnitSearch::Planned& UnitSearch::planned_for(const PointsView& points, double radius) {
  constexpr double kRounding = 0.99;
  const double most = kRounding * kSlack / 2 * radius;
  if (planned_ && planned_->radius == radius && planned_->at.size() == points.size() &&
      all_near(points.x, planned_->at.x, most) && all_near(points.y, planned_->at.y, most) &&
      all_near(points.z, planned_->at.z, most)) {
    return *planned_;
  }
  planned_.reset();  // there may be no room for two
  auto planned = std::make_unique<Planned>(Planned{.radius = radius,
                                                   .at = copy_of(points),
                                                   .cells = plan_cells(points, (1 + kSlack) * radius),
                                                   .sum = {}});
  planned->sum = take_plan_(planned->cells);
  planned_ = std::move(planned);
  return *planned_;
}

GaussianSums UnitSearch::sums(const PointsView& points, std::span<const double> weights,
                              const TruncatedGaussian& kernel, const RequestedSums& requested) {
  const Planned& planned = planned_for(points, kernel.radius);
  const double scale = std::sqrt(kernel.exponent * std::numbers::log2e);
  const double radius = scale * kernel.radius;
  UnitSums sums = planned.sum(points, weights, {scale, radius * radius, kernel.floor}, requested.gradient);

  GaussianSums result;
  result.kernel = std::accumulate(sums.kernel.begin(), sums.kernel.end(), 0.0);
  const auto ordered_pairs = std::accumulate(sums.pairs.begin(), sums.pairs.end(), std::uint64_t{0});
  result.pairs = (ordered_pairs - points.size()) / 2;  // each point met itself
  result.tested = planned.cells.tested;
  result.gradient = std::move(sums.gradient);
  if (requested.error)
    result.error = quality::truncation_bound(kernel, quality::spatial_order(points, kernel.radius), weights);
  return result;
}

}  // namespace crisp::cuda
