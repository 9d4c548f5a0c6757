// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <vector>

#include "pipeline/model/sensor_model.hpp"
#include "pipeline/quality/measure.hpp"
#include "plugins/calibrate/minimise.hpp"
#include "plugins/calibrate/sample.hpp"

namespace crisp {

/// How far from its start each kind of parameter is looked for: also what counts as known beforehand.
struct SearchRange {
  double lambda = 0.26;  ///< [rad]
  double tau = 0.10;     ///< [m]
  double alpha = 0.35;   ///< [rad]
  double eta = 0.10;     ///< [s]
  double other = 0.05;   ///< parameters of terms beyond equation (2) that have no bounds, in their units
};

/// The range that belongs to a parameter by its name.
double range_of(const SearchRange& range, const std::string& name);

/// Mean square displacement [m²] of a sample's points by each pair of the free parameters (m × m), rigid
/// motions of the whole cloud, which no measure of crispness sees, projected out.
Eigen::MatrixXd displacement(const SensorModel& model, const Sample& sample,
                             const std::vector<std::size_t>& free);

/// A basis of the free parameters, one direction a column, in which a unit step moves the sample's points by
/// `scale` [m], in the root mean square and apart from rigid motions.
Eigen::MatrixXd search_basis(const SensorModel& model, const Sample& sample,
                             const std::vector<std::size_t>& free, const SearchRange& range, double scale);

/// The model with other values of the free parameters.
SensorModel with(const SensorModel& model, const std::vector<std::size_t>& free, const Eigen::VectorXd& x);

/// The values of the parameters in `free`, or the ranges in which they are looked for: those of terms are a
/// share of their bounds.
Eigen::VectorXd picked(const SensorModel& model, const std::vector<std::size_t>& free);
Eigen::VectorXd ranges_of(const SearchRange& range, const SensorModel& model,
                          const std::vector<std::size_t>& free);

/// Turns the free parameters until the sample's cloud is as crisp as it can be at one scale, and leaves the
/// model there.
///
/// Works in search_basis(): without it λ against α (which differ by τ only) is a valley in which a search
/// creeps.
Minimum crispest(SensorModel& model, const Sample& sample, const std::vector<std::size_t>& free,
                 Measure& measure, double scale, const SearchRange& range, const MinimiserSettings& settings);

/// The same, ending earlier: for a kernel from whose optimum a narrower one goes on.
MinimiserSettings rough(MinimiserSettings settings);

/// σ from wide to narrow, by a constant factor of about 0.6.
std::vector<double> annealing(double from, double to);

}  // namespace crisp
