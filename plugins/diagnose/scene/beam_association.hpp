// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include <crisp/measurements.hpp>

#include "pipeline/quality/surfels.hpp"

namespace crisp::diagnose {

/// Stands for no surface in a BeamAssociation.
inline constexpr std::uint32_t kNoSurface = ~std::uint32_t{0};

/// Association of n beams with the surfaces that all beams show: the expected surface and the surface met.
/// Element i of all arrays is of beam i.
struct BeamAssociation {
  std::vector<std::uint32_t> ahead;  ///< first surface on the beam, well inside its known area; or kNoSurface
  std::vector<std::uint32_t> place;  ///< cell on that surface, see place_on(); unique over all surfaces
  std::vector<float> error;          ///< [m] range beyond that surface; 0 without one
  std::vector<float> cosine;         ///< |cos β| of the incidence there
  std::vector<std::uint32_t> end;    ///< surface nearest to the beam's end point, or kNoSurface
  std::vector<float> distance;       ///< [m] of the end point from it, along the beam
  std::vector<float> end_cosine;     ///< |cos β| of the incidence there

  std::size_t size() const { return ahead.size(); }
};

/// Associates each beam with the first surface on its way (ray casting). A surface is known in cells of 0.1 m
/// where its own beams ended. A beam hits it well inside where all cells around are known. Surfaces ahead are
/// met at less than 60° from their normal, end surfaces at less than 84°.
///
/// @param surfels  of these beams, not subsampled
/// @param ranges   [m] of the beams, from their lasers
BeamAssociation associate_beams(const quality::Surfels& surfels, const quality::BeamsView& beams,
                                const std::vector<float>& ranges);

/// [m] Robust standard deviation of the errors: 1.48 times the median absolute error. 0 without errors.
double usual_error(const BeamAssociation& association);

/// Whether two consecutive beams are neighbours in one scan.
inline bool are_neighbours(const Measurements& beams, std::size_t first, std::size_t second) {
  return beams.laser[first] == beams.laser[second] && beams.beam[first] + 1 == beams.beam[second];
}

}  // namespace crisp::diagnose
