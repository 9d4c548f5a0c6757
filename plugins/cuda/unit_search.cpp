// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/cuda/unit_search.hpp"

#include <cmath>
#include <numbers>
#include <numeric>

#include "pipeline/quality/searches.hpp"

namespace crisp::cuda {

std::unique_ptr<NeighbourIndex> UnitSearch::index(const PointsView& points, double radius) const {
  return GridSearch().index(points, radius);
}

GaussianSums UnitSearch::sums(const PointsView& points, std::span<const double> weights,
                              const TruncatedGaussian& kernel, const SumsWanted& wanted) {
  const CellPlan plan = plan_cells(points, kernel.radius);
  const Slots slots = fill_slots(plan, points, weights);
  const double scale = std::sqrt(kernel.exponent * std::numbers::log2e);
  const double radius = scale * kernel.radius;
  const UnitSums sums = sum_units_(plan, slots, {scale, radius * radius, kernel.floor}, wanted.gradient);

  GaussianSums result;
  result.kernel = std::accumulate(sums.kernel.begin(), sums.kernel.end(), 0.0);
  const auto ordered_pairs = std::accumulate(sums.pairs.begin(), sums.pairs.end(), std::uint64_t{0});
  result.pairs = (ordered_pairs - points.size()) / 2;  // each point met itself
  result.tested = plan.tested;
  if (wanted.error) result.error = truncation_bound(kernel, plan.order, weights);
  result.pull.assign(sums.pull.size(), 0);
  for (std::size_t slot = 0; slot < sums.pull.size(); ++slot) {
    const std::uint32_t i = plan.order.index[slot];
    const double factor = weights[i] / scale;
    result.pull.x[i] = factor * sums.pull.x[slot];
    result.pull.y[i] = factor * sums.pull.y[slot];
    result.pull.z[i] = factor * sums.pull.z[slot];
  }
  return result;
}

}  // namespace crisp::cuda
