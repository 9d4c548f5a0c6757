// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include <crisp/measure.hpp>

#include "pipeline/estimate/surfel_refinement.hpp"

namespace crisp::calibrate {

/// Which lasers' walls agree with those of the first one, or with those of another that does.
///
/// @return one a laser; all true where each laser that has walls in common with others agrees with one
std::vector<bool> agreeing_lasers(const estimate::Refinement& refined);

/// Calibrates lasers one after the other: a refinement by its own beams, then the λ at which the RQE of these
/// and of the beams of the lasers before it is least, then a refinement of all these. A search in the plate's
/// plane, as calibrate.rqe begins with, has two beams of each scan, which several λ may fit.
///
/// @param start     where the others' τ, α and η start
/// @param aligned   the lasers that agree already, at least one
/// @param settings  of the refinements
/// @param range     whose ranges of λ are searched, around their centres
/// @param report    called in each round, and before each laser; false ends the work
/// @throws Error  if no flat surface is seen
SensorModel calibrated_one_by_one(const SensorModel& start, std::vector<bool> aligned,
                                  const estimate::Sample& sample, const estimate::ParameterPrior& range,
                                  const estimate::RefinementSettings& settings, Measure& measure,
                                  const estimate::RoundReporter& report);

}  // namespace crisp::calibrate
