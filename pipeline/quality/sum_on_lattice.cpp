// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/quality/sum_on_lattice.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "pipeline/quality/blocks.hpp"
#include "pipeline/quality/lattice.hpp"
#include "pipeline/quality/spatial_order.hpp"

namespace crisp::quality {
namespace {

constexpr double kReach = 9;       // [σ] of the convolution: 2e-9 is left there
constexpr double kMaxNodes = 8e6;  // 64 MB a field

/// [σ] The distance between nodes: finer in a cloud that is small against σ, where errors would not cancel.
double step_for(const PointsView& points, double sigma) {
  double longest = 0;
  for (const auto& axis : {points.x, points.y, points.z}) {
    const auto [low, high] = std::ranges::minmax(axis);
    longest = std::max(longest, high - low);
  }
  return std::clamp(longest / sigma / 24, 0.125, 0.4);
}

/// Influence function (Hockney and Eastwood): convolution with it approximates exp(−(x/2σ)²) between two
/// quintic B-splines, optimal on average over the points' positions on the lattice. In Fourier space, over
/// the aliases ω + 2πk: Σ ĝ B̂² / (Σ B̂²)².
std::vector<double> influence_function(double step) {
  constexpr int kFrequencies = 512;
  constexpr int kAliases = 6;
  std::vector<double> half(static_cast<std::size_t>(kReach / step) + 1);
  for (int i = 0; i < kFrequencies; ++i) {
    const double omega = std::numbers::pi * (i + 0.5) / kFrequencies;
    const double sine2 = std::sin(omega / 2) * std::sin(omega / 2);
    double requested = 0;
    double there = 0;
    for (int k = -kAliases; k <= kAliases; ++k) {
      const double w = omega + 2 * std::numbers::pi * k;
      const double sinc2 = sine2 / (w * w / 4);
      const double spline2 = sinc2 * sinc2 * sinc2 * sinc2 * sinc2 * sinc2;
      requested += spline2 * std::exp(-w * w / (step * step)) * 2 * std::sqrt(std::numbers::pi) / step;
      there += spline2;
    }
    for (std::size_t m = 0; m < half.size(); ++m) {
      half[m] += requested / (there * there) * std::cos(omega * static_cast<double>(m)) / kFrequencies;
    }
  }
  return half;
}

/// Distances that the sums over tiles would compute for each unordered pair of cells: measured, about so many
/// for n points in a cell as wide as the radius.
double tests_by_pairs(const PointsView& points, double radius) {
  const SpatialOrder order = spatial_order(points, radius);
  double sum = 0;
  double in_cell = 0;
  for (std::size_t k = 0; k < order.cell.size(); ++k) {
    if (k > 0 && order.cell[k] != order.cell[k - 1]) {
      sum += in_cell * in_cell;
      in_cell = 0;
    }
    ++in_cell;
  }
  return 2 * (sum + in_cell * in_cell);
}

}  // namespace

bool lattice_pays(const PointsView& points, const TruncatedGaussian& kernel) {
  // Nanoseconds as measured on one core; what matters is their ratio.
  constexpr double kTest = 0.35;
  constexpr double kPoint = 250;
  constexpr double kNode = 25;
  const double nodes = Lattice::nodes_about(points, step_for(points, kernel.sigma) * kernel.sigma);
  const double cost = kPoint * static_cast<double>(points.size()) + kNode * nodes;
  // All pairs there are cost less than that already: no need for a closer estimate.
  const double all_pairs = 0.5 * static_cast<double>(points.size()) * static_cast<double>(points.size());
  if (nodes > kMaxNodes || kTest * all_pairs < cost) return false;
  return kTest * tests_by_pairs(points, kernel.radius) > cost;
}

GaussianSums sum_on_lattice(const PointsView& points, std::span<const double> weights,
                            const TruncatedGaussian& kernel, bool gradient) {
  constexpr std::size_t kBlock = 1024;  // points
  const double step = step_for(points, kernel.sigma);
  Lattice field(points, step * kernel.sigma);
  field.spread(points, weights);
  field.convolve(influence_function(step));
  GaussianSums result;
  if (gradient) result.gradient.assign(points.size(), 0);
  std::vector<double> blocks(blocks_of(points.size(), kBlock));
  for_blocks(points.size(), kBlock, [&](std::size_t b, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Lattice::Value at = field.at(points.x[i], points.y[i], points.z[i]);
      blocks[b] += weights[i] * at.value;
      if (!gradient) continue;
      // ∂/∂xᵢ of Σⱼ wⱼ exp(−exponent · d²) is −2 · exponent times what block_scores.
      const double scale = -weights[i] / (2 * kernel.exponent);
      result.gradient.x[i] = scale * at.gradient[0];
      result.gradient.y[i] = scale * at.gradient[1];
      result.gradient.z[i] = scale * at.gradient[2];
    }
  });
  for (const double block : blocks) result.kernel += block;
  return result;
}

}  // namespace crisp::quality
