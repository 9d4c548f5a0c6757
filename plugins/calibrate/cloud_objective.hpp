// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <vector>

#include <crisp/measure.hpp>
#include <crisp/sensor_model.hpp>

#include "pipeline/estimate/sample.hpp"

namespace crisp::calibrate {

/// Value of a cloud's quality and its derivatives with respect to the model's free parameters.
struct ModelQuality {
  double value = 0;
  Eigen::VectorXd gradient;  ///< one a free parameter
};

/// Quality of a sample's cloud and its gradient by the free parameters, by the chain rule: the quality's
/// gradient by every point times the point's derivative by the parameters.
///
/// @param model   at the parameters to be evaluated
/// @param sample  n beams, all of which encoder readings cover
/// @param free    indices into model.values()
/// @param scale   [m] the measure's
ModelQuality model_quality(const SensorModel& model, const estimate::Sample& sample,
                           const std::vector<std::size_t>& free, Measure& measure, double scale);

/// The value alone.
double model_quality(const SensorModel& model, const estimate::Sample& sample, Measure& measure,
                     double scale);

}  // namespace crisp::calibrate
