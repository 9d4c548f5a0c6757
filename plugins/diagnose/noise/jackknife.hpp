// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <crisp/calibration.hpp>

#include "plugins/diagnose/noise/noise_components.hpp"
#include "plugins/diagnose/noise/noise_model.hpp"

namespace crisp::diagnose {

/// A noise model fitted to convergence, with its delete-a-group jackknife replicates.
struct JackknifedModel {
  struct Without {
    double share = 0;  ///< share of the ranges that are left out
    NoiseModel model;
  };

  NoiseModel model;
  RangeErrors errors;           ///< data of the fit
  std::vector<Without> times;   ///< groups of the recording's blocks, interleaved
  std::vector<Without> places;  ///< groups of places on the surfaces, interleaved; empty if unknown
};

/// Fits the noise model and its jackknife replicates.
///
/// @param model  the selected noise model
JackknifedModel in_parts(const NoiseModel& model, const RangeErrors& errors);

/// Parameters of one noise component, with the jackknife's bias correction, clamped to the catalogue's bounds
/// so that they can be simulated. Means and weights per beam from some hundred ranges bias the shared
/// parameters, hence the correction. Standard errors are the larger of those over times and over places: the
/// deviation of a surface from a plane repeats at every turn.
std::vector<Parameter> parameters_of(const NoiseComponent& component, const JackknifedModel& fits);

}  // namespace crisp::diagnose
