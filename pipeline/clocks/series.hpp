// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

namespace crisp {

/// What of some columns fits a short series of values best beside what is expected of it.
struct SeriesFit {
  Eigen::Index column = 0;  ///< which
  double product = 0;      ///< of its unit vector beside the base with what the base leaves: what it explains
  Eigen::VectorXd values;  ///< of the base's columns, then of that one
  Eigen::VectorXd errors;  ///< of them: standard errors
  double rms = 0;          ///< of what is left
};

/// What the base leaves of columns, by least squares.
Eigen::MatrixXd off_base(const Eigen::MatrixXd& base, const Eigen::MatrixXd& columns);

/// Tries each of some columns beside a base, by least squares.
///
/// @param base     n × m: what is expected
/// @param columns  n × c: what is tried, one at a time
SeriesFit best_in_series(const Eigen::MatrixXd& base, const Eigen::MatrixXd& columns,
                         const Eigen::VectorXd& values);

/// Steps before each of n values but the `margin` outermost at either end: a column each.
Eigen::MatrixXd steps(Eigen::Index n, Eigen::Index margin);

/// How many values are before the step that a column of steps() describes.
Eigen::Index before_step(const Eigen::VectorXd& column);

}  // namespace crisp
