// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/diagnose/looks.hpp"

#include <Eigen/Eigenvalues>
#include <boost/math/distributions/chi_squared.hpp>
#include <cmath>
#include <limits>

namespace crisp {
namespace {

/// Directions in which a change of the parameters is seen, each of unit effect.
Eigen::MatrixXd seen_directions(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& squares) {
  constexpr double kNothing = 1e-3;  // share of a parameter's own effect
  const Eigen::VectorXd scale =
      squares.unaryExpr([](double square) { return square > 0 ? 1 / std::sqrt(square) : 0.0; });
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(scale.asDiagonal() * matrix *
                                                              scale.asDiagonal());
  const auto hidden = (solver.eigenvalues().array() <= kNothing).count();
  const Eigen::Index seen = matrix.cols() - hidden;
  return scale.asDiagonal() * solver.eigenvectors().rightCols(seen) *
         solver.eigenvalues().tail(seen).cwiseSqrt().cwiseInverse().asDiagonal();
}

/// By how much steps along some directions scatter, and how far they are beyond that.
struct StepSpread {
  Eigen::MatrixXd covariance;
  double wald = std::numeric_limits<double>::infinity();
};

/// By the division into blocks by which the steps are the most ordinary.
StepSpread widest(const NormalEquations& equations, const std::vector<std::size_t>& of,
                  const Eigen::MatrixXd& directions, const Eigen::VectorXd& steps) {
  StepSpread widest;
  for (std::size_t division = 0; division < equations.pulls.size(); ++division) {
    const Eigen::MatrixXd pulls = equations.pulls_along(division, of, directions);
    const Eigen::MatrixXd covariance = pulls * pulls.transpose();
    const double wald =
        steps.size() > 0 ? steps.dot(covariance.completeOrthogonalDecomposition().solve(steps)) : 0;
    if (wald < widest.wald) widest = {.covariance = covariance, .wald = wald};
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
  if (seen.cols() > 0) look.p_value = cdf(complement(boost::math::chi_squared(count), look.wald));
  return look;
}

}  // namespace crisp
