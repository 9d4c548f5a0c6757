// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

namespace crisp::statistics {

// Eigen's decompositions of dynamic matrices, compiled once. Each is some seconds of compile time wherever it
// is instantiated.

/// Eigenvalues in ascending order, and the orthonormal eigenvectors as columns.
struct SymmetricEigen {
  Eigen::VectorXd values;
  Eigen::MatrixXd vectors;
};

/// Eigendecomposition of a symmetric matrix, of which only the lower triangle is read.
SymmetricEigen eigendecomposition(const Eigen::MatrixXd& symmetric);

/// Solves A X = B for a positive definite A by LDLT.
Eigen::MatrixXd solve_positive_definite(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);

/// Solves A x = b for a positive definite A by LDLT.
Eigen::VectorXd solve_positive_definite(const Eigen::MatrixXd& a, const Eigen::VectorXd& b);

/// The x of least |A x − b| by QR with column pivoting.
Eigen::VectorXd least_squares(const Eigen::MatrixXd& a, const Eigen::VectorXd& b);

/// The shortest x of least |A x − b|, for an A of any rank, by a complete orthogonal decomposition.
Eigen::VectorXd minimum_norm_least_squares(const Eigen::MatrixXd& a, const Eigen::VectorXd& b);

/// Inverse by LU with partial pivoting. The matrix must be invertible.
Eigen::MatrixXd inverse(const Eigen::MatrixXd& matrix);

}  // namespace crisp::statistics
