// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

#include "pipeline/quality/line_segmentation.hpp"
#include "pipeline/quality/surfels.hpp"

namespace crisp::quality {

struct WallLineSettings {
  double noise = 0.012;  ///< [m] standard deviation of a range, with what views may disagree by
  RunPrices prices;
  std::size_t fewest = 5;  ///< beams of a wall, which is longer than the noise
  double gap = 2;          ///< [m] most between two pieces of one wall: a door, a window
};

/// Segments upright walls that beams in one plane see as lines: all beams in the order of their azimuth about
/// the origin are cut by straight_runs(). Runs that continue in one line beyond something else are joined;
/// short ones among scattered beams are rejected, since some leaves lie in a line by chance.
///
/// Unlike find_surfels() it needs views that agree to some of `noise`, and each beam counts: it detects a
/// window that five beams meet.
///
/// @param beams  near z = 0, about the spin axis, which no wall goes through
/// @return       walls with the most beams first, upright, each beam of weight 1
/// @throws Error  for points that are no numbers
Surfels wall_lines(const BeamsView& beams, const WallLineSettings& settings);

}  // namespace crisp::quality
