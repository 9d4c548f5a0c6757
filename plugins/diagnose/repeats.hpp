// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "pipeline/data/findings.hpp"
#include "pipeline/data/measurements.hpp"
#include "pipeline/data/plate_trajectory.hpp"
#include "plugins/diagnose/met.hpp"

namespace crisp {

/// What was seen at a direction at one time.
enum class Glimpse : std::uint8_t { kNone, kSurface, kHidden };

/// Directions in which a surface was seen at some times and hidden at others.
struct ChangingDirections {
  std::vector<std::vector<Glimpse>> looks;  ///< of each direction, by half turns of the plate
  std::vector<std::pair<std::size_t, std::size_t>> neighbours;  ///< among them
  double hidden = 0;  ///< share of the beams with a surface ahead that something hid from them there
};

/// A laser at the same plate angle looks along the same lines as a turn before, so that whatever stands still
/// hides the same. Directions are cells of plate angle, as wide as the plate turns between two scans, and of
/// two degrees of mirror angle. One counts as changing if five of the eight about it change, too: edges of
/// what stands still flicker in strips that are narrower.
///
/// @param beams  scan by scan of each laser; those that the plate's readings do not cover do not count
/// @param usual  [m] standard deviation of ranges, by usual_error()
ChangingDirections changing_directions(const Measurements& beams, const PlateTrajectory& plate,
                                       const Met& met, double usual);

/// How often chance makes neighbouring directions be hidden at the same time as often as these are: times
/// shuffled within each of them, 999 times.
double p_value(const ChangingDirections& directions, std::uint64_t seed);

/// Whether something moved (scene.moving).
/// @return  what is significant beyond 0.002 and concerns twenty directions at least
std::optional<Finding> moving(const ChangingDirections& directions, std::uint64_t seed);

}  // namespace crisp
