// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "pipeline/data/findings.hpp"
#include "pipeline/data/measurements.hpp"
#include "plugins/diagnose/met.hpp"
#include "plugins/diagnose/noise_law.hpp"

namespace crisp {

/// The errors of one laser's ranges on surfaces that stand before it, about the mean of each beam. A range
/// counts if the two beams beside it in its scan (of a laser with a single beam: before and after it) end on
/// the surface that is ahead of all three: what stands before a surface, an edge and one who walks by are
/// left out, yet no range is for being far off itself, up to 25 usual errors. Thin things before the surface
/// remain, and do but shorten: in place of ranges that are too short by five usual errors those that are too
/// long count twice, once with either sign.
///
/// @param usual  [m] standard deviation of ranges, by usual_error()
/// @param block  of each beam: see RangeErrors
RangeErrors scatter_of(std::size_t laser, const Measurements& beams, const Met& met, double usual,
                       const std::vector<std::uint32_t>& block);

/// [m] How much a law lets all but a hundredth of these ranges scatter by, in neither a tail nor two peaks.
double widest_deviation(const NoiseLaw& law, const RangeErrors& errors);

/// Whether a laser's noise changes with a covariate, beyond the law that was found for it: the noise of ten
/// groups of equally many ranges is compared with that of all.
///
/// @param name    of the covariate: "incidence"
/// @param values  of it, one a range
/// @return  what is significant beyond 0.002 and brings at least `least_gain` [nat] a range held out
std::optional<UnnamedFinding> noise_by(const std::string& name, std::span<const float> values,
                                       const std::string& scope, const RangeErrors& errors,
                                       const NoiseLaw& law, double least_gain, std::uint64_t seed);

}  // namespace crisp
