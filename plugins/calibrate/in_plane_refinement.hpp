// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "plugins/calibrate/claims.hpp"
#include "plugins/calibrate/surfel_refinement.hpp"

namespace crisp {

struct InPlaneRefinementSettings {
  SurfelSettings surfels{.floor = 0.001};
  ClaimSettings claims;
  SearchRange prior = RefinementSettings{}.prior;  ///< what is known less well from the data is refused
  double spread = 0.1;                             ///< [rad] see spread_upright()
  int searches = 2;                                ///< rounds in which walls are looked for
  int renewals = 5;         ///< rounds in which it is decided anew which wall each beam met
  int max_rounds = 20;      ///< steps in all
  double tolerance = 0.01;  ///< [standard errors] steps below which it has converged
};

/// The statistically efficient end of a calibration from the beams in the plate's plane alone: least squares
/// in the ranges against the walls that the beams meet, whose lines are estimated with the parameters.
///
/// In the first rounds each beam's wall is chosen anew, and walls grow to their ends; later they stay, so
/// that the steps come to an end.
///
/// @param start   right to some centimetres and degrees: see calibrate_in_plane()
/// @param sample  beams with θ near ±90°, all of which the plate's readings cover around the start
/// @param free    indices into start.values()
/// @throws Error  if no walls are seen, or the data determine one of `free` less well than `prior`
Refinement refine_in_plane(const SensorModel& start, const Sample& sample,
                           const std::vector<std::size_t>& free, const InPlaneRefinementSettings& settings);

}  // namespace crisp
