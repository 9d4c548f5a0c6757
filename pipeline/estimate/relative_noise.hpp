// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include <crisp/measurements.hpp>

#include "pipeline/quality/surfels.hpp"

namespace crisp::estimate {

/// Whether two beams that are next to one another on a surface are so in a scan, too.
inline bool are_neighbours(const Measurements& beams, std::uint32_t before, std::uint32_t beam) {
  constexpr double kOneScan = 0.005;  // [s] a quarter of a turn of the mirror
  return beams.laser[before] == beams.laser[beam] && beams.time[beam] - beams.time[before] <= kOneScan;
}

/// [m] Noise of ranges from neighbour to neighbour on flat surfaces: the root of the harmonic mean of the
/// beams' variances, as relative_noise() determines them. Neighbours share a calibration's error, so it does
/// not matter. 0 where there are too few.
double neighbour_noise(const quality::Surfels& surfels, const quality::BeamsView& placed,
                       const Measurements& beams, const quality::SurfelSettings& settings);

/// Relative noise of each beam's range, estimated from the data: a factor of its laser's, and one each of the
/// range, of the incidence and of the remission (in steps of equally many beams). They are estimated from
/// neighbours, beams of one scan on one surface, by the median of their differences. So disagreement between
/// lasers, or a model error, does not enter.
///
/// @param beams  n of them, with their incidences
/// @return  n: scaled so that the inverse squares of those on surfaces are 1 on average, which leaves the sum
///          of their weights what it is if all are alike. Empty where weights would reduce variances by less
///          than a twentieth, which is near chance for equal ones.
std::vector<float> relative_noise(const quality::Surfels& surfels, const quality::BeamsView& placed,
                                  const Measurements& beams, const quality::SurfelSettings& settings);

}  // namespace crisp::estimate
