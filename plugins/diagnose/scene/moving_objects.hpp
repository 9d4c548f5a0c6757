// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include <crisp/findings.hpp>

namespace crisp::diagnose {

/// Outlying ranges of a stationary laser, by beam.
struct FarShots {
  std::size_t scans = 0;
  std::size_t shots = 0;                            ///< number of shots evaluated
  std::vector<std::vector<std::uint32_t>> of_beam;  ///< scans with an outlying range
};

/// Moving objects in view of a stationary laser.
struct MovingObjects {
  std::vector<bool> beams;     ///< beams that met a moving object, and their neighbours
  std::size_t directions = 0;  ///< number of beams that it occluded or uncovered
  double share = 0;            ///< of all shots
  double p_value = 1;          ///< that outliers at random times cluster as much in each beam
};

/// Detects clusters of outlying ranges: connected in beam and scan, without a gap of more than one, of at
/// least twenty shots, three beams and three scans. Outliers of noise are single, and flicker at a static
/// edge affects one or two beams. The null distribution comes from a thousand permutations of the scans
/// within each beam.
///
/// @param views  number of lasers tested, for the correction of the p-value
/// @return  moving objects that are significant at p < 0.002
std::optional<MovingObjects> find_moving_objects(const FarShots& far, std::size_t views, std::uint64_t seed);

/// The finding scene.moving, of the same form as for a turning scanner.
Finding finding_of(const MovingObjects& moved);

}  // namespace crisp::diagnose
