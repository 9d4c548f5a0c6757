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

}  // namespace

Look look_at(const NormalEquations& equations, const std::vector<std::size_t>& of) {
  const Eigen::MatrixXd matrix = equations.matrix(of, of);
  const Eigen::VectorXd squares = equations.squares(of);
  const Eigen::MatrixXd seen = seen_directions(matrix, squares);
  const Eigen::VectorXd steps = -seen.transpose() * equations.vector(of);
  const Eigen::MatrixXd pulls = seen.transpose() * equations.pulls(of, Eigen::all);
  const double stiffer = equations.weight / equations.stiffness;
  const Eigen::MatrixXd scatter = pulls * pulls.transpose() * stiffer * stiffer;

  Look look;
  look.value = seen * steps;
  look.covariance = seen * scatter * seen.transpose();
  look.gain = steps.squaredNorm() / equations.covariance_factor();
  const auto count = static_cast<double>(seen.cols());
  look.bic = look.gain - count * std::log(static_cast<double>(equations.beams));
  look.visible = std::sqrt(steps.squaredNorm() / equations.weight);
  look.whole = std::sqrt(squares.dot(look.value.cwiseAbs2()) / equations.weight);
  look.whole_error = seen.cols() < matrix.cols()
                         ? std::numeric_limits<double>::infinity()
                         : std::sqrt(squares.dot(look.covariance.diagonal()) / equations.weight);
  if (seen.cols() > 0) {
    look.wald = steps.dot(scatter.completeOrthogonalDecomposition().solve(steps));
    look.p_value = cdf(complement(boost::math::chi_squared(count), look.wald));
  }
  return look;
}

}  // namespace crisp
