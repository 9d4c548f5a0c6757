// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <limits>
#include <string>
#include <vector>

#include "pipeline/model/sensor_model.hpp"

namespace crisp {

/// How far from its start each kind of parameter is looked for: also what counts as known beforehand.
struct SearchRange {
  double lambda = 0.26;  ///< [rad]
  double tau = 0.10;     ///< [m]
  double alpha = 0.35;   ///< [rad]
  double eta = 0.10;     ///< [s]
  double other = 0.05;   ///< parameters of terms beyond equation (2) that have no bounds, in their units
  /// [s] The η to which the plate's readings cover the beams at hand: nowhere is one looked for beyond.
  double earliest_eta = -std::numeric_limits<double>::infinity();
  double latest_eta = std::numeric_limits<double>::infinity();
};

/// The range that belongs to a parameter by its name.
double range_of(const SearchRange& range, const std::string& name);

/// Whether a parameter is an η at the end of what is looked at.
bool is_at_the_end(const SearchRange& range, const std::string& name, double value);

/// The model with other values of the free parameters.
SensorModel with(const SensorModel& model, const std::vector<std::size_t>& free, const Eigen::VectorXd& x);
SensorModel with_one(const SensorModel& model, std::size_t parameter, double value);

/// Values of the free parameters, those of terms no farther than their bounds.
Eigen::VectorXd within_bounds(const SensorModel& model, const std::vector<std::size_t>& free,
                              Eigen::VectorXd x);

/// The values of the parameters in `free`, or the ranges in which they are looked for: those of terms are a
/// share of their bounds.
Eigen::VectorXd picked(const SensorModel& model, const std::vector<std::size_t>& free);
Eigen::VectorXd ranges_of(const SearchRange& range, const SensorModel& model,
                          const std::vector<std::size_t>& free);

}  // namespace crisp
