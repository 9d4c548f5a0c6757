// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include <crisp/measurements.hpp>

namespace crisp::study {

/// Replaces some of the ranges at random, as rain, dust, glass and mirrors do: four fifths of them by one
/// anywhere between 0.3 m and what was met, the others by one up to 5 m behind it. Ranges below 0.3 m become
/// that.
///
/// @param share  of the beams, from 0 to 1
/// @param seed   which: other beams and ranges for another seed
void add_outliers(Measurements& beams, double share, std::uint64_t seed);

}  // namespace crisp::study
