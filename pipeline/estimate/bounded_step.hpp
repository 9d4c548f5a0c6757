// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

namespace crisp::estimate {

/// Bounds of a step, for each parameter: infinite where there is none.
struct StepBounds {
  Eigen::VectorXd lower;
  Eigen::VectorXd upper;
};

/// Newton step within bounds: minimizes gᵀd + dᵀHd/2 for lower ≤ d ≤ upper by an active-set method (Nocedal
/// and Wright, Numerical Optimization, 2006, 16.5). Clamping the free step instead leaves the other
/// parameters where a parameter beyond its bound would take them.
///
/// @param matrix  H, n × n, symmetric and positive definite
Eigen::VectorXd bounded_step(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& gradient,
                             const StepBounds& bounds);

}  // namespace crisp::estimate
