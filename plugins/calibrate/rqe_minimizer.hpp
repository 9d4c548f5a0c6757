// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <vector>

#include <crisp/measure.hpp>
#include <crisp/sensor_model.hpp>

#include "pipeline/estimate/parameter_prior.hpp"
#include "pipeline/estimate/sample.hpp"
#include "plugins/calibrate/ipopt_minimizer.hpp"

namespace crisp::calibrate {

/// A basis of the free parameters, one direction a column, in which a unit step moves the sample's points by
/// `scale` [m], in the root mean square and apart from rigid motions.
Eigen::MatrixXd search_basis(const SensorModel& model, const estimate::Sample& sample,
                             const std::vector<std::size_t>& free, const estimate::ParameterPrior& range,
                             double scale);

/// Minimizes the RQE of the sample's cloud over the free parameters at one scale, and leaves the model there.
///
/// Works in search_basis(): without it λ against α (which differ by τ only) is an ill-conditioned direction
/// in which a search converges slowly.
Minimum minimize_rqe(SensorModel& model, const estimate::Sample& sample, const std::vector<std::size_t>& free,
                     Measure& measure, double scale, const estimate::ParameterPrior& range,
                     const MinimizerSettings& settings);

/// The same, ending earlier: for a kernel from whose optimum a narrower one goes on.
MinimizerSettings rough(MinimizerSettings settings);

/// σ from wide to narrow, by a constant factor of about 0.6.
std::vector<double> annealing(double from, double to);

}  // namespace crisp::calibrate
