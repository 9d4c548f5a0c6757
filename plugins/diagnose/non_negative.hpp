// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

namespace crisp {

/// A weighted linear regression whose few coefficients must not be negative.
class NonNegativeProblem {
 public:
  explicit NonNegativeProblem(std::size_t coefficients);

  /// An observation of `value` that should be the sum of coefficients times `levers`.
  void add(std::span<const double> levers, double value, double weight);

  /// The coefficients with the least squares: of all sets of them, the others being 0, the best that needs no
  /// negative one. Those of which the observations say nothing (their levers are 0, or another's) are 0.
  std::vector<double> solution() const;

 private:
  Eigen::MatrixXd normal_;
  Eigen::VectorXd right_;
};

}  // namespace crisp
