// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

#include "pipeline/quality/straight_runs.hpp"
#include "pipeline/quality/surfels.hpp"

namespace crisp {

struct WallLineSettings {
  double noise = 0.012;  ///< [m] standard deviation of a range, with what views may disagree by
  RunPrices prices;
  std::size_t fewest = 5;  ///< beams of a wall, which is longer than the noise
  double gap = 2;          ///< [m] most between two pieces of one wall: a door, a window
};

/// Finds upright walls that beams in one plane see as lines: all beams in the order of their azimuth about
/// the origin are cut into straight_runs(). Runs that go on in one line beyond something else are joined;
/// short ones among beams that are on nothing straight are left out, for among leaves some lie in a line by
/// chance.
///
/// Other than find_surfels() it needs views that agree to some of `noise`, and each beam counts: a window
/// that five beams meet is found.
///
/// @param beams  near z = 0, about the spin axis, which no wall goes through
/// @return       walls with the most beams first, upright, each beam of weight 1
/// @throws Error  for points that are no numbers
Surfels wall_lines(const BeamsView& beams, const WallLineSettings& settings);

}  // namespace crisp
