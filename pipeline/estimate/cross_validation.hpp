// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <optional>

#include "pipeline/estimate/surfel_refinement.hpp"

namespace crisp::estimate {

/// Distance of the clouds of two calibrations that are fitted to either half of a recording.
struct CrossValidation {
  double difference = 0;  ///< [m] between the clouds (RMS), rigid motions apart
  double expected = 0;    ///< [m] by the two calibrations' covariances
  double ratio() const { return difference / expected; }  ///< 1: the standard errors are honest
};

/// Refines a model with the beams of every other turn of the plate, and with those of the turns between.
///
/// @param model  a refined one
/// @param go_on  whether the work is to go on
/// @param known  surfaces that the model was fitted to; null: they are searched for
/// @return       nothing where the plate made less than two turns, or the halves determine other parameters
std::optional<CrossValidation> cross_validate(const SensorModel& model, const Sample& sample,
                                              const RefinementSettings& settings, const RoundReporter& go_on,
                                              const std::shared_ptr<const SurfaceMap>& known = nullptr);

}  // namespace crisp::estimate
