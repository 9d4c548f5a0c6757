// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "pipeline/estimate/cross_validation.hpp"
#include "pipeline/estimate/outcome.hpp"
#include "pipeline/estimate/recording_lags.hpp"
#include "pipeline/estimate/sample.hpp"
#include "pipeline/estimate/view_consistency.hpp"
#include "pipeline/quality/measure.hpp"
#include "pipeline/stage/context.hpp"

namespace crisp {

struct CrispnessSettings {
  double sigma = 0.05;         ///< [m]
  std::size_t points = 60000;  ///< about so many
};

/// [nat] How crisp the cloud is with each of some models, by the same beams: spread evenly over the surfaces
/// that the first one puts them on, and covered by the plate's readings at the lags of all.
std::vector<double> crispness_of(const std::vector<SensorModel>& models, const Sample& sample,
                                 const CrispnessSettings& settings, Measure& measure);

/// Puts a calibration into the run's summary: the table for people, all of its numbers for programs, and a
/// warning for each parameter that is not observable, unless a stage above has said so of `start`.
void tell(const Calibration& calibration, const Calibration& start, Context& context);

/// The recordings, and each one's lags, for people and for programs.
void tell(const RecordingLags& lags, const PlateTrajectory& plate, Context& context);

/// How far the halves of a recording agree.
void tell(const std::optional<CrossValidation>& halves, Context& context);

/// How consistent the views are: all pairs for programs, the least consistent one for people.
void tell(const std::vector<ViewConsistency>& views, Context& context);

}  // namespace crisp
