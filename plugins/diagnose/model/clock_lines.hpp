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
#include "pipeline/estimate/parameter_prior.hpp"

namespace crisp::diagnose {

/// Standard error of each laser's skew against the plate's clock, as the clock maps have it; 0 for a clock
/// without a map, which counts as exact.
std::vector<double> skew_errors(const Rig& rig, const std::map<std::string, ClockMap>& clocks);

/// Adds the skew of each clock line that is not exact (the term clock.skew) to the base model, with its
/// standard error as its prior.
///
/// @param errors  by laser: see skew_errors()
/// @param middle  [s since the run's epoch] of the recording, where each η is that of its clock
void add_clock_lines(Calibration& calibration, estimate::ParameterPrior& prior,
                     const std::vector<double>& errors, double middle, const TermRegistry& terms);

/// The outcome without the skews of clock lines, which hold for its recording only. Each η is that in the
/// middle of the recording.
estimate::Outcome without_clock_lines(const estimate::Outcome& outcome, const TermRegistry& terms);

/// The skews that the surfaces determine better than the stamps.
std::optional<EstimatorArtifact> clock_lines(const estimate::Outcome& outcome,
                                             const estimate::ParameterPrior& prior);

}  // namespace crisp::diagnose
