// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

namespace crisp::statistics {

/// Non-negative least squares (NNLS) for few coefficients.
class NonNegativeProblem {
 public:
  explicit NonNegativeProblem(std::size_t coefficients);

  /// Adds an observation `value` with regressors `levers`.
  void add(std::span<const double> levers, double value, double weight);

  /// Adds the observations of another problem with as many coefficients.
  void operator+=(const NonNegativeProblem& other);

  /// Least-squares coefficients over all active sets whose solution is non-negative. Coefficients that the
  /// observations do not identify (zero or collinear regressors) are 0.
  std::vector<double> solution() const;

 private:
  Eigen::MatrixXd normal_;
  Eigen::VectorXd right_;
};

}  // namespace crisp::statistics
