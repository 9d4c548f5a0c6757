// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <span>

#include <crisp/measurements.hpp>

namespace crisp::table {

/// Angles and firing times of a scan's beams.
struct BeamSequence {
  double first_angle = 0;  ///< [rad] of beam 0: reported angle less mount
  double angle_step = 0;   ///< [rad]
  double first_time = 0;   ///< [s since the epoch] of beam 0
  double interval = 0;     ///< [s]
  std::uint16_t laser = 0;
};

/// One echo of each beam of a scan.
struct BeamEchoes {
  std::span<const float> ranges;      ///< [m], 0 where there is none
  std::span<const float> remissions;  ///< as many, or none
};

/// Adds the beams that came back; of several echoes each as a beam of the same instant.
/// @param echoes  of the same number of beams
void append_beams(const BeamSequence& sequence, std::span<const BeamEchoes> echoes, Measurements& to);

}  // namespace crisp::table
