// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "pipeline/data/findings.hpp"
#include "plugins/diagnose/noise_ways.hpp"

namespace crisp {

/// [m²] Mean product of the errors of beams that follow one another in a scan: what they are off by together,
/// which is no noise. 0 where none follow one another.
///
/// @param law  that the errors have: what it hardly makes is left out
double shared_by_neighbours(const RangeErrors& errors, const NoiseLaw& law);

/// Why a law that pays on other parts of the recording is none all the same, in words; empty: it is one.
///
/// @param found  with its parameters and standard errors
/// @param law    that has it
std::string refusal_of(const Finding& found, const NoiseWay& way, const NoiseLaw& law,
                       const RangeErrors& errors);

}  // namespace crisp
