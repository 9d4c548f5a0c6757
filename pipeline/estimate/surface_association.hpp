// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pipeline/quality/surfels.hpp"

namespace crisp::estimate {

struct AssociationSettings {
  double margin = 0.35;  ///< [m] by which a surface may reach beyond the beams that it was found from
  double spacings = 0;   ///< or by so many distances between its beams, where that is more
  double gate = 4.7;     ///< [standard deviations of the noise] farthest beam that is claimed
};

/// Associates each beam with the surface that it meets. find_surfels() leaves out cells with an edge or a
/// corner, which can hold a sixth of the beams where walls are strips of points. Here a surface gets each
/// beam that ends on its plane and not far beyond its borders; in corners and at edges the beam's
/// intersection decides.
///
/// @return  the same surfaces with their associated beams, each of weight 1; those with fewer than
///          settings.min_points are removed. Planes stay as they are: see refine().
quality::Surfels associate_with_surfaces(const quality::Surfels& found, const quality::BeamsView& beams,
                                         const quality::SurfelSettings& settings,
                                         const AssociationSettings& associations = {});

/// Lets surfaces claim what is left, again and again while they grow: where beams are few, as on a house
/// front that is far away, most of a surface lies beyond the beams that it was found from.
///
/// @return  the same surfaces with more beams, each of weight 1. Planes are left as they are: see refine().
quality::Surfels grow_surfaces(const quality::Surfels& surfels, const quality::BeamsView& beams,
                               const quality::SurfelSettings& settings,
                               const AssociationSettings& associations);

}  // namespace crisp::estimate
