// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/diagnose/looks.hpp"

#include <algorithm>
#include <boost/math/distributions/fisher_f.hpp>
#include <cmath>
#include <limits>

#include "pipeline/statistics/dense_solvers.hpp"

namespace crisp {
namespace {

/// Directions in which a change of the parameters is seen, each of unit effect.
Eigen::MatrixXd seen_directions(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& squares) {
  constexpr double kNothing = 1e-3;  // share of a parameter's own effect
  const Eigen::VectorXd scale =
      squares.unaryExpr([](double square) { return square > 0 ? 1 / std::sqrt(square) : 0.0; });
  const SymmetricEigen eigen = eigendecomposition(scale.asDiagonal() * matrix * scale.asDiagonal());
  const auto hidden = (eigen.values.array() <= kNothing).count();
  const Eigen::Index seen = matrix.cols() - hidden;
  return scale.asDiagonal() * eigen.vectors.rightCols(seen) *
         eigen.values.tail(seen).cwiseSqrt().cwiseInverse().asDiagonal();
}

/// By how much steps along some directions scatter, and how far they are beyond that.
struct StepSpread {
  Eigen::MatrixXd covariance;
  double wald = std::numeric_limits<double>::infinity();
  double p_value = 1;
};

/// How many squares of one normal law would scatter as the sum of these does: as many as there are if all are
/// alike, fewer if some count for most.
double alike(const Eigen::VectorXd& values) {
  const double squares = values.squaredNorm();
  return squares > 0 ? 3 * squares * squares / values.array().pow(4).sum() : 0;
}

/// Hotelling's: a covariance that is known from n blocks only, p of whose freedoms the steps themselves have
/// taken, makes large multiples of it likelier than χ² has them.
///
/// @param steps  p, not none; so many blocks count as are alike along them
double by_hotelling(const Eigen::MatrixXd& pulls, const Eigen::VectorXd& steps,
                    const Eigen::VectorXd& solved) {
  const auto p = static_cast<double>(steps.size());
  const double n = std::min(alike(pulls.transpose() * solved), static_cast<double>(pulls.cols()));
  const double left = n - 2 * p + 1;
  if (!(left > 0)) return 1;
  return cdf(complement(boost::math::fisher_f(p, left), steps.dot(solved) * left / (n * p)));
}

/// Rao and Scott's: noise of its own for each beam would scatter alike in all directions of the steps; by how
/// much blocks scatter more is told along the steps alone, for which few of them suffice. Where blocks do not
/// scatter alike in all directions it is the less likely to be sure.
double by_rao_and_scott(const Eigen::MatrixXd& pulls, const Eigen::VectorXd& steps) {
  const auto p = static_cast<double>(steps.size());
  const Eigen::VectorXd along = pulls.transpose() * steps.normalized();
  const double n = std::min(alike(along), static_cast<double>(pulls.cols()));
  const double left = n - p;
  if (!(left > 0 && along.squaredNorm() > 0)) return 1;
  const double ratio = steps.squaredNorm() / along.squaredNorm();
  return cdf(complement(boost::math::fisher_f(p, left), ratio * left / (n * p)));
}

/// By the division into blocks by which the steps are the most ordinary.
StepSpread widest(const NormalEquations& equations, const std::vector<std::size_t>& of,
                  const Eigen::MatrixXd& directions, const Eigen::VectorXd& steps) {
  if (steps.size() == 0) return {.covariance = Eigen::MatrixXd(0, 0), .wald = 0};
  StepSpread widest{.covariance = {}, .p_value = 0};
  for (std::size_t division = 0; division < equations.pulls.size(); ++division) {
    const Eigen::MatrixXd pulls = equations.pulls_along(division, of, directions);
    const Eigen::MatrixXd covariance = pulls * pulls.transpose();
    const Eigen::VectorXd solved = minimum_norm_least_squares(covariance, steps);
    widest.p_value = std::max(widest.p_value,
                              std::min(by_hotelling(pulls, steps, solved), by_rao_and_scott(pulls, steps)));
    if (steps.dot(solved) > widest.wald) continue;
    widest.wald = steps.dot(solved);
    widest.covariance = covariance;
  }
  return widest;
}

}  // namespace

double Look::sharing() const {
  constexpr double kChance = 1.5;  // 3.5 standard errors of what a hundred blocks show
  const double ratio = wald > 0 ? gain / wald : 1;
  return ratio > kChance ? ratio : 1;
}

Look look_at(const NormalEquations& equations, const std::vector<std::size_t>& of) {
  const Eigen::MatrixXd matrix = equations.matrix(of, of);
  const Eigen::VectorXd squares = equations.squares(of);
  const Eigen::MatrixXd seen = seen_directions(matrix, squares);
  const Eigen::VectorXd steps = -seen.transpose() * equations.vector(of);
  const StepSpread spread = widest(equations, of, seen, steps);

  Look look;
  look.value = seen * steps;
  look.covariance = seen * spread.covariance * seen.transpose();
  look.gain = steps.squaredNorm() / equations.covariance_factor();
  const auto count = static_cast<double>(seen.cols());
  look.bic = look.gain - count * std::log(static_cast<double>(equations.beams));
  look.visible = std::sqrt(steps.squaredNorm() / equations.weight);
  look.whole = std::sqrt(squares.dot(look.value.cwiseAbs2()) / equations.weight);
  const double changed = of.empty() ? 1 : std::max(1.0, equations.changed(of).maxCoeff());
  const Eigen::VectorXd in_ranges = equations.range_squares(of) / changed;
  look.ranges = std::sqrt(in_ranges.dot(look.value.cwiseAbs2()));
  look.ranges_error = seen.cols() < matrix.cols() ? std::numeric_limits<double>::infinity()
                                                  : std::sqrt(in_ranges.dot(look.covariance.diagonal()));
  look.wald = spread.wald;
  look.p_value = spread.p_value;
  return look;
}

}  // namespace crisp
