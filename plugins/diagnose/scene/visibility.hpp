// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include <crisp/findings.hpp>
#include <crisp/measurements.hpp>
#include <crisp/plate_trajectory.hpp>

#include "plugins/diagnose/scene/beam_association.hpp"

namespace crisp::diagnose {

/// Visibility of the surface in one direction at one time.
enum class Visibility : std::uint8_t { kNone, kSurface, kHidden };

/// Directions in which a surface is visible at some times and occluded at others.
struct ChangingDirections {
  std::vector<std::vector<Visibility>> views;                   ///< by direction, then half turn of the plate
  std::vector<std::pair<std::size_t, std::size_t>> neighbours;  ///< pairs of adjacent directions
  double hidden = 0;  ///< share of occluded beams among those with a surface ahead
};

/// Detects directions of changing visibility. At the same plate angle a laser measures along the same lines
/// as one turn before, so static objects occlude the same. Directions are cells of plate angle (as wide as
/// the plate turns between two scans) and of two degrees of mirror angle. Within a column, scans of different
/// turns have different angles, so that the outline of a static object changes a cell as well. There the
/// visibility alternates less often from angle to angle than from time to time; such cells do not count. A
/// direction counts as changing if five of its eight neighbours change, too.
///
/// @param beams  scan by scan of each laser; beams not covered by encoder readings do not count
/// @param usual  [m] standard deviation of ranges, by usual_error()
ChangingDirections changing_directions(const Measurements& beams, const PlateTrajectory& plate,
                                       const BeamAssociation& association, double usual);

/// Permutation test against independent flicker: p-value of the number of adjacent directions occluded at the
/// same time, from 999 random permutations of the times within each direction.
double p_value(const ChangingDirections& directions, std::uint64_t seed);

/// Tests for moving objects (scene.moving).
///
/// @return  a finding that is significant at p < 0.002, covers at least twenty directions and hides at least
///          0.05 % of the beams
std::optional<Finding> moving(const ChangingDirections& directions, std::uint64_t seed);

}  // namespace crisp::diagnose
