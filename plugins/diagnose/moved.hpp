// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "pipeline/data/findings.hpp"

namespace crisp {

/// Where a laser at rest measured something else than what each beam usually meets.
struct FarShots {
  std::size_t scans = 0;
  std::size_t shots = 0;                            ///< that were looked at
  std::vector<std::vector<std::uint32_t>> of_beam;  ///< scans in which it was far off
};

/// What moved before a laser at rest.
struct Moved {
  std::vector<bool> beams;     ///< before which it did, and those beside them
  std::size_t directions = 0;  ///< beams that it covered, or uncovered
  double share = 0;            ///< of all shots
  double p_value = 1;          ///< that far shots of each beam, strewn over time, lie together as much
};

/// Looks for far shots that lie together: without a gap of more than one beam or scan, twenty at least, over
/// three beams and three scans at least. Outliers of a law of noise come singly, and what flickers at an edge
/// of what stands still is of a beam or two. How much lies together by chance is seen in a thousand shuffles
/// of the scans within each beam, for each laser that is looked at.
///
/// @param looks  so many lasers are looked at; the p-value is corrected for them
/// @return  what is significant beyond 0.002
std::optional<Moved> moved(const FarShots& far, std::size_t looks, std::uint64_t seed);

/// scene.moving, as it is told of a scanner that turns.
Finding finding_of(const Moved& moved);

}  // namespace crisp
