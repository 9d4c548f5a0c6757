// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <functional>
#include <string>

namespace crisp::calibrate {

/// A function to be minimized: returns its value at x and, where `gradient` is not null, sets it.
using Objective = std::function<double(const Eigen::VectorXd& x, Eigen::VectorXd* gradient)>;

/// The box of the search, and a basis in which the cost is about equally curved in every direction: the
/// optimizer works on y with x = start + basis * y. A unit of y should be a typical step.
struct Box {
  Eigen::VectorXd lower;
  Eigen::VectorXd upper;
  Eigen::MatrixXd basis;  ///< n × n, regular
};

struct MinimizerSettings {
  int max_iterations = 60;
  double tolerance = 1e-5;  ///< change of the cost, relative to 1 or its value, below which the search ends
  std::function<bool()> interrupted = {};  ///< polled once an iteration; stops the search where it is
};

struct Minimum {
  Eigen::VectorXd x;
  double value = 0;
  int iterations = 0;
  bool converged = false;
  std::string status;  ///< Ipopt's verdict in words
};

/// Minimizes `objective` in `box` from `start`, with Ipopt's filter line search (Wächter and
/// Biegler 2006) and a secant approximation of the Hessian; where the way leads to the border of the box,
/// once more with the interior-point method. Several threads may call it: the linear solver, which is not
/// re-entrant, works for one at a time, while the others' objectives are evaluated.
///
/// @param start  n values; moved into the box where it lies outside
/// @throws Error  if the sizes differ or the objective is not finite at the start
Minimum minimize(const Objective& objective, const Eigen::VectorXd& start, const Box& box,
                 const MinimizerSettings& settings);

}  // namespace crisp::calibrate
