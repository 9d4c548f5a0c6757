// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/diagnose/model/score_test.hpp"

#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/fisher_f.hpp>
#include <cmath>
#include <limits>
#include <optional>

#include "pipeline/statistics/dense_solvers.hpp"

namespace crisp::diagnose {

Eigen::MatrixXd observable_directions(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& squares) {
  constexpr double kNothing = 1e-3;  // share of a parameter's own squared effect
  const Eigen::VectorXd scale =
      squares.unaryExpr([](double square) { return square > 0 ? 1 / std::sqrt(square) : 0.0; });
  const statistics::SymmetricEigen eigen =
      statistics::eigendecomposition(scale.asDiagonal() * matrix * scale.asDiagonal());
  const auto hidden = (eigen.values.array() <= kNothing).count();
  const Eigen::Index seen = matrix.cols() - hidden;
  return scale.asDiagonal() * eigen.vectors.rightCols(seen) *
         eigen.values.tail(seen).cwiseSqrt().cwiseInverse().asDiagonal();
}

namespace {

/// Covariance of steps along the observable directions, and its excess over independent errors.
struct StepSpread {
  Eigen::MatrixXd covariance;
  double wald = std::numeric_limits<double>::infinity();
  double p_value = 1;
  bool is_testable = false;
};

/// p-value where blocks are too few to measure how much errors scatter in excess: their variance is taken to
/// be at most a hundred times that of independent errors.
double by_largest_excess(double gain, double steps) {
  constexpr double kLargest = 100;
  return cdf(complement(boost::math::chi_squared(steps), gain / kLargest));
}

/// Effective number of equally distributed squares in a sum (Satterthwaite's approximation): their number if
/// all are equal, fewer if some dominate.
double alike(const Eigen::VectorXd& values) {
  const double squares = values.squaredNorm();
  return squares > 0 ? 3 * squares * squares / values.array().pow(4).sum() : 0;
}

/// p-value by Hotelling's T²: the covariance is known from n blocks, and the steps take p of their degrees of
/// freedom. It exceeds the p-value by χ².
///
/// @param steps  p > 0 steps; the effective number of blocks along them counts
/// @return nothing if the blocks are too few
std::optional<double> by_hotelling(const Eigen::MatrixXd& block_scores, const Eigen::VectorXd& steps,
                                   const Eigen::VectorXd& solved) {
  const auto p = static_cast<double>(steps.size());
  const double n =
      std::min(alike(block_scores.transpose() * solved), static_cast<double>(block_scores.cols()));
  const double left = n - 2 * p + 1;
  if (!(left > 0)) return std::nullopt;
  return cdf(complement(boost::math::fisher_f(p, left), steps.dot(solved) * left / (n * p)));
}

/// p-value with Rao and Scott's first-order correction (1984): independent beam errors scatter equally in all
/// directions, so the excess is estimated along the steps alone, for which few blocks suffice. It is
/// conservative where the excess differs between directions.
std::optional<double> by_rao_and_scott(const Eigen::VectorXd& along, double n, const Eigen::VectorXd& steps) {
  const auto p = static_cast<double>(steps.size());
  const double left = n - p;
  if (!(left > 0 && along.squaredNorm() > 0)) return std::nullopt;
  const double ratio = steps.squaredNorm() / along.squaredNorm();
  return cdf(complement(boost::math::fisher_f(p, left), ratio * left / (n * p)));
}

/// Statistics of the division into blocks that gives the largest p-value. A division with fewer blocks than
/// steps tests nothing.
StepSpread widest(const quality::NormalEquations& equations, const std::vector<std::size_t>& of,
                  const Eigen::MatrixXd& directions, const Eigen::VectorXd& steps, double gain) {
  const auto p = static_cast<double>(steps.size());
  if (steps.size() == 0) return {.covariance = Eigen::MatrixXd(0, 0), .wald = 0};
  StepSpread widest{.covariance = {}, .p_value = 0};
  for (std::size_t division = 0; division < equations.block_scores.size(); ++division) {
    const Eigen::MatrixXd block_scores = equations.scores_along(division, of, directions);
    const Eigen::MatrixXd covariance = block_scores * block_scores.transpose();
    const Eigen::VectorXd solved = statistics::minimum_norm_least_squares(covariance, steps);
    const auto first = by_hotelling(block_scores, steps, solved);
    const Eigen::VectorXd along = block_scores.transpose() * steps.normalized();
    const double blocks = std::min(alike(along), static_cast<double>(along.size()));
    const auto second = by_rao_and_scott(along, blocks, steps);
    if (first || second) {
      double p_value = std::min(first.value_or(1), second.value_or(1));
      if (blocks < 2 * p) p_value = std::min(p_value, by_largest_excess(gain, p));
      widest.p_value = std::max(widest.p_value, p_value);
      widest.is_testable = true;
    }
    if (steps.dot(solved) > widest.wald) continue;
    widest.wald = steps.dot(solved);
    widest.covariance = covariance;
  }
  if (!widest.is_testable) widest.p_value = by_largest_excess(gain, p);
  return widest;
}

}  // namespace

double ScoreTest::design_effect() const {
  constexpr double kChance = 1.5;  // 3.5 standard errors of the estimate from a hundred blocks
  const double ratio = wald > 0 ? gain / wald : 1;
  return ratio > kChance ? ratio : 1;
}

ScoreTest score_test(const quality::NormalEquations& equations, const std::vector<std::size_t>& of) {
  const Eigen::MatrixXd matrix = equations.matrix(of, of);
  const Eigen::VectorXd squares = equations.squares(of);
  const Eigen::MatrixXd seen = observable_directions(matrix, squares);
  const Eigen::VectorXd steps = -seen.transpose() * equations.vector(of);
  ScoreTest test;
  test.gain = steps.squaredNorm() / equations.covariance_factor();
  const StepSpread spread = widest(equations, of, seen, steps, test.gain);
  test.value = seen * steps;
  test.covariance = seen * spread.covariance * seen.transpose();
  const auto count = static_cast<double>(seen.cols());
  test.bic = test.gain - count * std::log(static_cast<double>(equations.beams));
  test.visible = std::sqrt(steps.squaredNorm() / equations.weight);
  test.whole = std::sqrt(squares.dot(test.value.cwiseAbs2()) / equations.weight);
  const double changed = of.empty() ? 1 : std::max(1.0, equations.changed(of).maxCoeff());
  const Eigen::VectorXd in_ranges = equations.range_squares(of) / changed;
  test.ranges = std::sqrt(in_ranges.dot(test.value.cwiseAbs2()));
  test.ranges_error = seen.cols() < matrix.cols() ? std::numeric_limits<double>::infinity()
                                                  : std::sqrt(in_ranges.dot(test.covariance.diagonal()));
  test.wald = spread.wald;
  test.p_value = spread.p_value;
  test.is_testable = spread.is_testable;
  return test;
}

}  // namespace crisp::diagnose
