// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <utility>

#include <crisp/error.hpp>
#include <crisp/rqe.hpp>

#include "pipeline/quality/blocks.hpp"
#include "pipeline/quality/searches.hpp"
#include "pipeline/quality/truncation_bound.hpp"

namespace crisp {

Rqe rqe(const PointsView& points, std::span<const double> weights, const RqeSettings& settings) {
  quality::GridSearch search;
  return rqe(points, weights, settings, search);
}

Rqe rqe(const PointsView& points, std::span<const double> weights, const RqeSettings& settings,
        Search& search) {
  check(points);
  check_weights(weights, points.size());
  if (points.size() == 0)
    throw Error("the entropy of a cloud without points is not defined", "give at least one point");
  const TruncatedGaussian kernel(settings.sigma, settings.cutoff);
  const auto scaled = with_mean_one(weights, points.size());
  GaussianSums sums = search.sums(points, scaled, kernel, {settings.gradient, settings.error_bound});

  Rqe result;
  const auto n = static_cast<double>(points.size());
  result.energy = kernel.peak * sums.kernel / (n * n);
  result.value = -std::log(result.energy);
  result.pairs = sums.pairs;
  result.tested = sums.tested;
  result.error_bound = std::log1p(sums.error / sums.kernel);
  result.gradient = std::move(sums.gradient);
  // H = −log E, and xᵢ is in both orders of each of its pairs: ∂H/∂xᵢ = 4 · exponent · pull / kernel.
  const double scale = 4 * kernel.exponent / sums.kernel;
  for (auto* axis : {&result.gradient.x, &result.gradient.y, &result.gradient.z}) {
    quality::for_blocks(axis->size(), 65536, [&](std::size_t, std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) (*axis)[i] *= scale;
    });
  }
  return result;
}

}  // namespace crisp
