// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pipeline/quality/surfels.hpp"

namespace crisp {

struct ClaimSettings {
  double margin = 0.35;  ///< [m] by which a surface may reach beyond the beams that it was found from
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

}  // namespace crisp
