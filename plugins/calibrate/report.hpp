// SPDX-License-Identifier: BSD-3-Clause
#pragma once

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

/// Compares calibrations by the crispness of the same beams, spread evenly over the surfaces.
class Crispness {
 public:
  /// @param model  places the beams to be chosen
  Crispness(const Sample& sample, const SensorModel& model, const CrispnessSettings& settings,
            Measure& measure);
  double of(const SensorModel& model) const;

 private:
  Sample beams_;
  double sigma_;
  Measure& measure_;
};

/// Puts a calibration into the run's summary: the table for people, all of its numbers for programs, and a
/// warning for each parameter that is not observable, unless a stage above has said so of `start`.
void tell(const Calibration& calibration, const Calibration& start, Context& context);

/// The recordings, and each one's lags, for people and for programs.
void tell(const RecordingLags& lags, const PlateTrajectory& plate, Context& context);

/// How consistent the views are: all pairs for programs, the least consistent one for people.
void tell(const std::vector<ViewConsistency>& views, Context& context);

}  // namespace crisp
