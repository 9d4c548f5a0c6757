// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "pipeline/data/measurements.hpp"
#include "pipeline/quality/surfels.hpp"

namespace crisp {

/// Whether two beams that are next to one another on a surface are so in a scan, too.
inline bool are_neighbours(const Measurements& beams, std::uint32_t before, std::uint32_t beam) {
  constexpr double kOneScan = 0.005;  // [s] a quarter of a turn of the mirror
  return beams.laser[before] == beams.laser[beam] && beams.time[beam] - beams.time[before] <= kOneScan;
}

/// [m] By how much ranges scatter from neighbour to neighbour on flat surfaces: the root of the harmonic mean
/// of the beams' variances, as relative_noise() determines them. However wrong a calibration is, neighbours
/// share its error. 0 where too few are there.
double neighbour_noise(const Surfels& surfels, const BeamsView& placed, const Measurements& beams,
                       const SurfelSettings& settings);

/// How much each beam's range scatters beside the others', as the data show it: a factor of its laser's, and
/// one each of the range, of the incidence and of the remission (in steps of equally many beams). They are
/// told from neighbours, beams of one scan on one surface: how the median of their differences goes with each
/// of these. So nothing of it is how far lasers disagree, or a model is off.
///
/// @param beams  n of them, with the incidences found
/// @return  n: scaled so that the inverse squares of those on surfaces are 1 on average, which leaves the sum
///          of their weights what it is if all are alike. None where weights would make variances less by
///          under a twentieth: that is near what chance makes of equal ones.
std::vector<float> relative_noise(const Surfels& surfels, const BeamsView& placed, const Measurements& beams,
                                  const SurfelSettings& settings);

}  // namespace crisp
