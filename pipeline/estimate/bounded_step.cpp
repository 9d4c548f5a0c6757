// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/estimate/bounded_step.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <optional>
#include <vector>

namespace crisp::estimate {
namespace {

using Indices = std::vector<Eigen::Index>;

/// Minimizes over the free parameters while the others keep their steps.
void minimize_over(const Indices& free, const Eigen::MatrixXd& matrix, const Eigen::VectorXd& gradient,
                   Eigen::VectorXd& step) {
  for (const Eigen::Index i : free) step[i] = 0;
  const Eigen::VectorXd slopes = gradient + matrix * step;
  Eigen::VectorXd slope(static_cast<Eigen::Index>(free.size()));
  std::ranges::transform(free, slope.begin(), [&](Eigen::Index i) { return slopes[i]; });
  const Eigen::VectorXd minimum = -matrix(free, free).ldlt().solve(slope);
  for (std::size_t k = 0; k < free.size(); ++k) step[free[k]] = minimum[static_cast<Eigen::Index>(k)];
}

/// The first bound on the way from one step to another.
struct Block {
  Eigen::Index parameter = 0;
  double bound = 0;
  double share = 1;  ///< of the way
};

std::optional<Block> first_bound(const Indices& free, const Eigen::VectorXd& from, const Eigen::VectorXd& to,
                                 const StepBounds& bounds) {
  std::optional<Block> first;
  for (const Eigen::Index i : free) {
    const bool rises = to[i] > from[i];
    const double bound = rises ? bounds.upper[i] : bounds.lower[i];
    const bool is_beyond = rises ? to[i] > bound : to[i] < bound;
    if (!is_beyond) continue;
    const double share = (bound - from[i]) / (to[i] - from[i]);
    if (!first || share < first->share) first = {.parameter = i, .bound = bound, .share = share};
  }
  return first;
}

/// The parameter on its bound whose multiplier is the most negative: the objective falls inside.
std::optional<Eigen::Index> released(const Indices& active, const Eigen::MatrixXd& matrix,
                                     const Eigen::VectorXd& gradient, const StepBounds& bounds,
                                     const Eigen::VectorXd& step) {
  const Eigen::VectorXd slope = gradient + matrix * step;
  std::optional<Eigen::Index> best;
  double least = 0;
  for (const Eigen::Index i : active) {
    const double multiplier = step[i] <= bounds.lower[i] ? slope[i] : -slope[i];
    if (multiplier >= least) continue;
    least = multiplier;
    best = i;
  }
  return best;
}

}  // namespace

Eigen::VectorXd bounded_step(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& gradient,
                             const StepBounds& bounds) {
  const Eigen::Index n = gradient.size();
  Eigen::VectorXd step = Eigen::VectorXd::Zero(n).cwiseMax(bounds.lower).cwiseMin(bounds.upper);
  Indices free;
  Indices active;
  for (Eigen::Index i = 0; i < n; ++i) free.push_back(i);
  const auto most_changes = 4 * n;  // far more than occur; bounds a cycle by rounding
  for (Eigen::Index change = 0; change <= most_changes; ++change) {
    Eigen::VectorXd next = step;
    minimize_over(free, matrix, gradient, next);
    const auto block = first_bound(free, step, next, bounds);
    step += (block ? block->share : 1) * (next - step);
    if (block) {
      step[block->parameter] = block->bound;
      std::erase(free, block->parameter);
      active.push_back(block->parameter);
      continue;
    }
    const auto inside = released(active, matrix, gradient, bounds, step);
    if (!inside) break;
    std::erase(active, *inside);
    free.push_back(*inside);
  }
  return step.cwiseMax(bounds.lower).cwiseMin(bounds.upper);
}

}  // namespace crisp::estimate
