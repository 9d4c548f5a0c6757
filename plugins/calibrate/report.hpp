// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include <crisp/context.hpp>
#include <crisp/measure.hpp>

#include "pipeline/estimate/cross_validation.hpp"
#include "pipeline/estimate/outcome.hpp"
#include "pipeline/estimate/recording_lags.hpp"
#include "pipeline/estimate/sample.hpp"
#include "pipeline/estimate/view_consistency.hpp"

namespace crisp::calibrate {

struct CrispnessSettings {
  double sigma = 0.05;         ///< [m]
  std::size_t points = 60000;  ///< about so many
};

/// [nat] RQE of the cloud under each of some models, for the same beams: spread evenly over the surfaces on
/// which the first model puts them, and covered by encoder readings at the lags of all.
std::vector<double> rqe_of(const std::vector<SensorModel>& models, const estimate::Sample& sample,
                           const CrispnessSettings& settings, Measure& measure);

/// Adds a calibration to the run's summary: the table for people, all of its numbers for programs, and a
/// warning for each unobservable parameter, unless a stage above has reported it for `start`.
void report(const Calibration& calibration, const Calibration& start, Context& context);

/// What determines the plate's direction (note_direction()), for programs; for people if that is the rig
/// alone, unless a stage above has reported it for `start`.
void report_direction(const Calibration& calibration, const Calibration& start, Context& context);

/// The recordings, and each one's lags, for people and for programs.
void report(const estimate::RecordingLags& lags, const PlateTrajectory& plate, Context& context);

/// Reports the agreement of a recording's halves.
void report(const std::optional<estimate::CrossValidation>& halves, Context& context);

/// How consistent the views are: all pairs for programs, the least consistent one for people.
void report(const std::vector<estimate::ViewConsistency>& views, Context& context);

}  // namespace crisp::calibrate
