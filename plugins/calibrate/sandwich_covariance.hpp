// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "plugins/calibrate/rqe_minimizer.hpp"

namespace crisp::calibrate {

struct SandwichSettings {
  double scale = 0.05;      ///< [m] the measure's
  double noise = 0.012;     ///< [m] standard deviation of a range
  std::size_t probes = 32;  ///< the standard errors are known to 1/√(2 · probes) of themselves
  std::uint64_t seed = 1;
  estimate::ParameterPrior range;  ///< a parameter's standard error is at most of this size
};

/// H⁻¹ B H⁻¹ in the directions in which a measure has a minimum. Others have a standard error of ten times
/// their range, so that they are not observable, and leave the rest as it is.
///
/// @param hessian  m × m, H in the coordinates of the basis
/// @param spread   m × m, B in these coordinates
/// @param basis    m × m, of the parameters' directions
/// @param ranges   m, of the parameters
/// @return m × m, of the parameters
Eigen::MatrixXd sandwich(const Eigen::MatrixXd& hessian, const Eigen::MatrixXd& spread,
                         const Eigen::MatrixXd& basis, const Eigen::VectorXd& ranges);

/// Sandwich covariance of a measure's optimum under the noise of the ranges: H⁻¹ B H⁻¹, where H is the
/// measure's Hessian and B the covariance of its gradient (Huber 1967). H is computed from differences of the
/// gradient, B from gradients after random changes of all ranges; see sandwich().
///
/// @param model  at the optimum
/// @return m × m, positive definite, in the order of `free`
Eigen::MatrixXd sandwich_covariance(const SensorModel& model, const estimate::Sample& sample,
                                    const std::vector<std::size_t>& free, Measure& measure,
                                    const SandwichSettings& settings);

}  // namespace crisp::calibrate
