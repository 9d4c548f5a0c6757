// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "pipeline/data/measurements.hpp"
#include "pipeline/quality/surfels.hpp"

namespace crisp {

inline constexpr std::uint32_t kNoSurface = ~std::uint32_t{0};

/// What n beams should have met, by the surfaces that all of them show together, and what they did meet.
/// Element i of all arrays is of beam i.
struct Met {
  std::vector<std::uint32_t>
      ahead;  ///< the surface before it, well inside what is known of it; or kNoSurface
  std::vector<std::uint32_t> place;  ///< of that surface, see place_on(); no other surface's has its number
  std::vector<float> error;          ///< [m] of its range beyond that surface; 0 where there is none
  std::vector<float> cosine;         ///< |cos β| there
  std::vector<std::uint32_t> end;    ///< the surface nearest to where it ended; kNoSurface: near none
  std::vector<float> distance;       ///< [m] along the beam from there
  std::vector<float> end_cosine;     ///< |cos β| there

  std::size_t size() const { return ahead.size(); }
};

/// Follows each beam to the first surface before it. A surface is known where its beams ended, in cells of a
/// decimetre, and well inside where it is known all around; only surfaces met at less than 60° from their
/// normal count as ahead, those met at less than 84° as ends.
///
/// @param surfels  of these beams, not thinned
/// @param ranges   [m] of the beams, by which their points lie before their lasers
Met met_by(const Surfels& surfels, const BeamsView& beams, const std::vector<float>& ranges);

/// [m] Robust standard deviation of the errors: 1.48 times the median of their sizes. 0 without any.
double usual_error(const Met& met);

/// Whether two beams that follow one another are neighbours in one scan.
inline bool are_neighbours(const Measurements& beams, std::size_t first, std::size_t second) {
  return beams.laser[first] == beams.laser[second] && beams.beam[first] + 1 == beams.beam[second];
}

}  // namespace crisp
