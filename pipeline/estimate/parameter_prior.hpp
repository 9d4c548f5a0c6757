// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include <crisp/rig.hpp>
#include <crisp/sensor_model.hpp>

#include "pipeline/estimate/bounded_step.hpp"

namespace crisp::estimate {

/// A rig's prior knowledge of a parameter.
struct NominalValue {
  double value = 0;
  double std_error = 0;  ///< > 0
};

/// The nominal values of which the rig gives the standard deviation, by the parameters' full names
/// ("laser1.tau").
std::map<std::string, NominalValue> nominal_values(const Rig& rig);

/// The search range of each kind of parameter around its start: also its prior standard deviation.
struct ParameterPrior {
  double lambda = 0.26;  ///< [rad]
  double tau = 0.10;     ///< [m]
  double alpha = 0.35;   ///< [rad]
  double eta = 0.10;     ///< [s]
  double other = 0.05;   ///< parameters of terms beyond equation (2) that have no bounds, in their units
  /// [s] The η to which encoder readings cover the beams at hand: the search stays within.
  double earliest_eta = -std::numeric_limits<double>::infinity();
  double latest_eta = std::numeric_limits<double>::infinity();
  /// Narrower priors of the rig, around its nominal values instead of around the start.
  std::map<std::string, NominalValue> nominal = {};
  double reach = 1;  ///< [standard deviations] of a nominal value that its range has
};

/// The range that belongs to a parameter by its name.
double range_of(const ParameterPrior& range, const std::string& name);

/// Whether a parameter is an η at the end of its search range.
bool is_at_the_end(const ParameterPrior& range, const std::string& name, double value);

/// The model with other values of the free parameters.
SensorModel with(const SensorModel& model, const std::vector<std::size_t>& free, const Eigen::VectorXd& x);
SensorModel with_one(const SensorModel& model, std::size_t parameter, double value);

/// Steps by which the parameters of terms reach their bounds.
StepBounds step_bounds(const SensorModel& model, const std::vector<std::size_t>& free);

/// The values of the parameters in `free`, or their search ranges: a fraction of the bounds for parameters of
/// terms.
Eigen::VectorXd picked(const SensorModel& model, const std::vector<std::size_t>& free);
Eigen::VectorXd ranges_of(const ParameterPrior& range, const SensorModel& model,
                          const std::vector<std::size_t>& free);
/// Whether the parameter is an amplitude of a term, whose prior is about the neutral value: none is expected.
/// What the data hardly determine, as a curve where there are few beams, stays near it.
bool is_amplitude(const SensorModel& model, std::size_t parameter);

/// The means of the priors: those of amplitudes are neutral, of the others as centres_of() has them.
Eigen::VectorXd prior_means(const ParameterPrior& range, const SensorModel& start,
                            const std::vector<std::size_t>& free);

/// [1/unit²] Information on each parameter by nominal values; 0 where there is none.
Eigen::VectorXd nominal_information(const ParameterPrior& range, const SensorModel& model,
                                    const std::vector<std::size_t>& parameters);

/// The centres of the search: the rig's nominal value where it has a standard deviation, else the model's.
Eigen::VectorXd centres_of(const ParameterPrior& range, const SensorModel& model,
                           const std::vector<std::size_t>& free);

}  // namespace crisp::estimate
