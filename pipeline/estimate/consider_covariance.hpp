// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include <crisp/calibration.hpp>

namespace crisp::estimate {

/// Consider covariance (Schmidt 1966): the effect of parameters held at their prior on the estimates of the
/// others. An estimate moves by S per unit of a held parameter.
struct ConsiderCovariance {
  Eigen::MatrixXd covariance;  ///< m × m, of the estimates, with the prior uncertainty of the held parameters
  /// Estimates whose variance comes more from held parameters than from the data, each with its identifiable
  /// combination.
  std::vector<Unobservable> dependent;
};

/// @param covariance   m × m, of the estimates, as if the held ones were known
/// @param information  (m + h) × (m + h), Fisher's, of the estimates and then of the held ones
/// @param names        m + h
/// @param prior        h standard deviations of the held ones, in their units
ConsiderCovariance consider(const Eigen::MatrixXd& covariance, const Eigen::MatrixXd& information,
                            const std::vector<std::string>& names, const Eigen::VectorXd& prior);

}  // namespace crisp::estimate
