// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

#include "pipeline/quality/surfels.hpp"

namespace crisp::quality {

/// [beams] Number of consecutive beams in a block.
inline constexpr std::size_t kResidualBlock = 8192;

/// How one beam of a surfel stands to the plane that fits the surfel's beams best.
struct SurfelResidual {
  double distance = 0;      ///< [m] of the point from the plane, along the normal
  double incidence = 0;     ///< cosine between the beam and the normal; negative, as one points to the other
  double spread = 0;        ///< [m] standard deviation of the distance that the noise of ranges makes
  double weight = 0;        ///< 0 to 1: how much it counts
  double range_change = 0;  ///< [m] by which the range would have to grow to end on the plane
  double u = 0, v = 0;      ///< [m] where the beam meets the plane, from the surfel's middle

  /// Whether the beam all but runs along the plane.
  bool grazes() const {
    constexpr double kGrazing = 0.05;
    return std::abs(incidence) < kGrazing;
  }
};

/// The residuals of a surfel's beams, in the order of its members, after a plane has been fitted to them once
/// more: by weighted least squares in the distances, with the places where the beams meet the plane as
/// regressors, so that noise along the beams does not tilt it.
std::vector<SurfelResidual> residuals_of(const Surfel& surfel, const Surfels& surfels, const BeamsView& beams,
                                         const SurfelSettings& settings);

/// Sets the weights of a surfel's beams, and moves its plane to where such a fit puts it. Beams that their
/// own view contradicts by more than noise does count less or nothing, those that all but run along the plane
/// nothing.
void refine(Surfel& surfel, Surfels& surfels, const BeamsView& beams, const SurfelSettings& settings);
void refine_all(Surfels& surfels, const BeamsView& beams, const SurfelSettings& settings);

/// Moves planes that most beams meet aslant to where their beams now are, with the weights as they are.
/// Residuals are linear in the change of a plane; one that beams graze may turn by only a fraction of that
/// angle before they are not.
void refit_all(Surfels& surfels, const BeamsView& beams, const SurfelSettings& settings);

}  // namespace crisp::quality
