// SPDX-License-Identifier: BSD-3-Clause
#include <array>
#include <cmath>

#include <crisp/neighbour_search.hpp>

#include "pipeline/quality/blocks.hpp"
#include "pipeline/quality/searches.hpp"
#include "pipeline/quality/truncation_bound.hpp"

namespace crisp {
namespace {

struct BlockSums {
  double kernel = 0;
  std::uint64_t listed = 0;
};

/// Adds what the neighbours of point i do to it.
void add_point(const PointsView& points, std::span<const double> weights, const TruncatedGaussian& kernel,
               std::size_t i, std::span<const std::uint32_t> near, std::span<const double> squared_distance,
               BlockSums& sums, Vectors& gradient) {
  double sum = 0;
  std::array<double, 3> own_gradient{};
  for (std::size_t k = 0; k < near.size(); ++k) {
    const std::uint32_t j = near[k];
    const double g = std::exp(-kernel.exponent * squared_distance[k]);
    sum += weights[j] * (g - kernel.floor);
    own_gradient[0] += weights[j] * g * (points.x[i] - points.x[j]);
    own_gradient[1] += weights[j] * g * (points.y[i] - points.y[j]);
    own_gradient[2] += weights[j] * g * (points.z[i] - points.z[j]);
  }
  sums.kernel += weights[i] * sum;
  sums.listed += near.size();
  if (gradient.size() == 0) return;
  gradient.x[i] = weights[i] * own_gradient[0];
  gradient.y[i] = weights[i] * own_gradient[1];
  gradient.z[i] = weights[i] * own_gradient[2];
}

}  // namespace

GaussianSums Search::sums(const PointsView& points, std::span<const double> weights,
                          const TruncatedGaussian& kernel, const RequestedSums& requested) {
  constexpr std::size_t kBlock = 256;  // points
  const auto neighbours = index(points, kernel.radius);
  GaussianSums result;
  if (requested.gradient) result.gradient.assign(points.size(), 0);
  std::vector<BlockSums> blocks(quality::blocks_of(points.size(), kBlock));
  quality::for_blocks(points.size(), kBlock, [&](std::size_t b, std::size_t first, std::size_t last) {
    Neighbours near;
    neighbours->near(first, last, near);
    for (std::size_t i = first; i < last; ++i) {
      const std::size_t begin = near.begin[i - first];
      const std::size_t count = near.begin[i - first + 1] - begin;
      add_point(points, weights, kernel, i, std::span(near.index).subspan(begin, count),
                std::span(near.squared_distance).subspan(begin, count), blocks[b], result.gradient);
    }
  });
  for (const BlockSums& block : blocks) {
    result.kernel += block.kernel;
    result.tested += block.listed;
  }
  if (requested.error)
    result.error = quality::truncation_bound(kernel, quality::spatial_order(points, kernel.radius), weights);
  result.pairs = (result.tested - points.size()) / 2;  // each from either end, and each point has itself
  return result;
}

void register_built_in(SearchRegistry& registry) {
  registry.add("flann", "a k-d tree (FLANN): the reference",
               [] { return std::make_unique<quality::FlannSearch>(); });
  registry.add("grid", "tiles of cells along a Morton curve, vectorized: the fast one",
               [] { return std::make_unique<quality::GridSearch>(); });
  registry.add("exact", "every pair: for tests and few points",
               [] { return std::make_unique<quality::ExactSearch>(); });
}

}  // namespace crisp
