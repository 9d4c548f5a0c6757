// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <crisp/findings.hpp>
#include <crisp/measurements.hpp>

#include "plugins/diagnose/noise/noise_model.hpp"
#include "plugins/diagnose/scene/beam_association.hpp"

namespace crisp::diagnose {

/// Range errors of one laser on static surfaces, about the mean of each beam. A range counts if both
/// neighbouring beams of its scan (for a single-beam laser: the previous and next shot) end on the surface
/// ahead of all three. This excludes foreground objects, edges and passers-by, but no range for its own error
/// up to 25 standard deviations. Thin foreground objects remain, and only shorten ranges. Hence ranges that
/// are too short by five standard deviations are replaced by those too long, counted with both signs.
///
/// @param usual  [m] standard deviation of ranges, by usual_error()
/// @param block  of each beam: see RangeErrors
RangeErrors scatter_of(std::size_t laser, const Measurements& beams, const BeamAssociation& association,
                       double usual, const std::vector<std::uint32_t>& block);

/// [m] 99 % quantile of the model's standard deviation over these ranges, without tail and second peak.
double widest_deviation(const NoiseModel& model, const RangeErrors& errors);

/// Tests whether a laser's noise depends on a covariate beyond its noise model, by ten quantile groups of
/// ranges.
///
/// @param name    of the covariate: "incidence"
/// @param values  the covariate of each range
/// @return  a dependence that is significant at p < 0.002 and gains at least `least_gain` [nat] per held-out
/// range
std::optional<UnnamedFinding> noise_by(const std::string& name, std::span<const float> values,
                                       const std::string& scope, const RangeErrors& errors,
                                       const NoiseModel& model, double least_gain, std::uint64_t seed);

}  // namespace crisp::diagnose
