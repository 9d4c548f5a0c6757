// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "pipeline/estimate/surfel_refinement.hpp"

namespace crisp::estimate {

/// Each recording has clock lines of its own, whose errors (some 10 µs), and whatever changed when a device
/// started anew, are in the lags of its lasers.
struct RecordingLags {
  Eigen::MatrixXd beyond;  ///< [s] recordings × lasers: η there less the laser's mean over all; 0 if unknown
  Eigen::MatrixXd std_errors;  ///< [s] of η there; infinite if unknown
};

/// Finds η of each laser in each recording alone, everything else as the model has it.
///
/// @param model  right to some centimetres and degrees
RecordingLags lags_of_recordings(const SensorModel& model, const Sample& sample,
                                 const RefinementSettings& settings);

/// The sample with its times moved so that every recording has the same lags, as far as they are known.
Sample with_common_lags(Sample sample, const RecordingLags& lags);

}  // namespace crisp::estimate
