// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include <crisp/measurements.hpp>
#include <crisp/plate_trajectory.hpp>

namespace crisp::diagnose {

/// Difference of the encoder angle between two times at which a laser measured the same ranges.
struct AngleShift {
  std::size_t laser = 0;
  double earlier = 0;       ///< [s since epoch] mean time of the earlier scans
  double later = 0;         ///< [s since epoch] of the later ones
  double rate_earlier = 0;  ///< [rad/s] of the plate
  double rate_later = 0;    ///< [rad/s] of the plate
  double shift = 0;         ///< [rad] the later scans' angle less the earlier scans', modulo a turn
};

/// Registers scans of each laser with scans of earlier passes over the same plate angle, in blocks of five
/// scans. The registration minimizes the mean truncated difference of the ranges, interpolated over the plate
/// angle. It needs no calibration: effects of the plate angle alone (eccentricity, wobble) cancel.
///
/// @param beams  scan by scan of each laser; beams that the encoder readings do not cover are left out
/// @return  shifts with a clear minimum within 20 degrees, by laser and later time; none where no pass
///          repeats another
std::vector<AngleShift> angle_shifts(const Measurements& beams, const PlateTrajectory& plate);

}  // namespace crisp::diagnose
