// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include <crisp/clock_map.hpp>
#include <crisp/findings.hpp>
#include <crisp/rig.hpp>

#include "pipeline/estimate/outcome.hpp"
#include "plugins/diagnose/model/hypothesis.hpp"

namespace crisp::diagnose {

/// Standard error of each laser's skew against the plate's clock, as the clock maps have it; 0 for a clock
/// without a map, which counts as exact.
std::vector<double> skew_errors(const Rig& rig, const std::map<std::string, ClockMap>& clocks);

/// Marks accepted drifts of a laser's clock as errors of its clock line: the mean skew is within three of its
/// standard errors, and the skew's change alone is too small to be selected as a cause. Such a drift corrects
/// the line, and is no cause.
///
/// @param middle      [s since the run's epoch] of the recording
/// @param least_chi2  χ² from which on one parameter is selected
void mark_clock_lines(std::vector<Hypothesis>& hypotheses, const estimate::Outcome& outcome,
                      const std::vector<double>& skew_errors, double middle, double least_chi2);

/// The skews by which the lines of the clocks were corrected.
std::optional<EstimatorArtifact> clock_lines(const std::vector<Hypothesis>& hypotheses,
                                             const estimate::Outcome& outcome);

}  // namespace crisp::diagnose
