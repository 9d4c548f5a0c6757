// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/statistics/dense_solvers.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace crisp {
namespace {

using namespace crisp::statistics;

TEST(DenseSolvers, DecomposeAHandWorkedSymmetricMatrix) {
  const Eigen::MatrixXd matrix{{2.0, 1.0}, {1.0, 2.0}};  // eigenvalues 1 and 3, along the diagonals
  const SymmetricEigen eigen = eigendecomposition(matrix);
  EXPECT_NEAR(eigen.values[0], 1, 1e-14);
  EXPECT_NEAR(eigen.values[1], 3, 1e-14);
  EXPECT_NEAR(std::abs(eigen.vectors.col(0).dot(Eigen::VectorXd{{1.0, -1.0}})), std::sqrt(2), 1e-14);
  EXPECT_NEAR(std::abs(eigen.vectors.col(1).dot(Eigen::VectorXd{{1.0, 1.0}})), std::sqrt(2), 1e-14);
}

TEST(DenseSolvers, SolveForVectorsAndMatricesAlike) {
  const Eigen::MatrixXd a{{4.0, 2.0}, {2.0, 3.0}};
  const Eigen::VectorXd x{{1.0, -2.0}};
  const Eigen::VectorXd b = a * x;
  EXPECT_NEAR((solve_positive_definite(a, b) - x).norm(), 0, 1e-14);
  EXPECT_NEAR((solve_positive_definite(a, Eigen::MatrixXd(b)) - x).norm(), 0, 1e-14);
  EXPECT_NEAR((inverse(a) * a - Eigen::MatrixXd::Identity(2, 2)).norm(), 0, 1e-14);
}

TEST(DenseSolvers, FitALineByLeastSquares) {
  // y = 0, 0, 3 at x = 0, 1, 2: the normal equations give intercept −1/2 and slope 3/2.
  const Eigen::MatrixXd design{{1.0, 0.0}, {1.0, 1.0}, {1.0, 2.0}};
  const Eigen::VectorXd fit = least_squares(design, Eigen::VectorXd{{0.0, 0.0, 3.0}});
  EXPECT_NEAR(fit[0], -0.5, 1e-14);
  EXPECT_NEAR(fit[1], 1.5, 1e-14);
}

TEST(DenseSolvers, GiveTheShortestSolutionOfASingularSystem) {
  const Eigen::MatrixXd singular{{1.0, 1.0}, {1.0, 1.0}};  // any x with x₀ + x₁ = 2 solves it
  const Eigen::VectorXd shortest = minimum_norm_least_squares(singular, Eigen::VectorXd{{2.0, 2.0}});
  EXPECT_NEAR(shortest[0], 1, 1e-14);
  EXPECT_NEAR(shortest[1], 1, 1e-14);
}

}  // namespace
}  // namespace crisp
