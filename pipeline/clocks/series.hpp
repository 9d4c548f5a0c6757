// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

namespace crisp::clocks {

/// The best-fitting column for a short series of values, next to a base of expected regressors.
struct SeriesFit {
  Eigen::Index column = 0;  ///< which
  double product =
      0;  ///< scalar product of its unit vector, orthogonal to the base, with the base's residual
  Eigen::VectorXd values;  ///< of the base's columns, then of that one
  Eigen::VectorXd errors;  ///< of them: standard errors
  double rms = 0;          ///< of what is left
};

/// Residual of columns after the base, by least squares.
Eigen::MatrixXd off_base(const Eigen::MatrixXd& base, const Eigen::MatrixXd& columns);

/// Tests each column jointly with the base, by least squares.
///
/// @param base     n × m: expected regressors
/// @param columns  n × c: tested regressors, one at a time
SeriesFit best_in_series(const Eigen::MatrixXd& base, const Eigen::MatrixXd& columns,
                         const Eigen::VectorXd& values);

/// Steps before each of n values but the `margin` outermost at either end: a column each.
Eigen::MatrixXd steps(Eigen::Index n, Eigen::Index margin);

/// Number of values before the step that a column of steps() describes.
Eigen::Index before_step(const Eigen::VectorXd& column);

}  // namespace crisp::clocks
