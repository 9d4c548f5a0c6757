// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pipeline/quality/surfels.hpp"

namespace crisp {

struct ClaimSettings {
  double margin = 0.35;  ///< [m] by which a surface may reach beyond the beams that it was found from
  double spacings = 0;   ///< or by so many distances between its beams, where that is more
  double gate = 4.7;     ///< [standard deviations of the noise] farthest beam that is claimed
};

/// Gives each beam to the surface that it meets. find_surfels() leaves out whatever shares a cell with an
/// edge or a corner; that can be a sixth of the beams where walls are strips of points. Here a surface claims
/// each beam that ends on its plane and not much beyond its borders; in corners and at edges the one that the
/// beam meets.
///
/// @return  the same surfaces with the beams that they claim, each of weight 1; those that claim fewer than
///          settings.min_points are gone. Planes are left as they are: see refine().
Surfels claimed(const Surfels& found, const BeamsView& beams, const SurfelSettings& settings,
                const ClaimSettings& claims = {});

/// Lets surfaces claim what is left, again and again while they grow: where beams are few, as on a house
/// front that is far away, most of a surface lies beyond the beams that it was found from.
///
/// @return  the same surfaces with more beams, each of weight 1. Planes are left as they are: see refine().
Surfels grown(const Surfels& surfels, const BeamsView& beams, const SurfelSettings& settings,
              const ClaimSettings& claims);

}  // namespace crisp
