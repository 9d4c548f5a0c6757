// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <span>

#include "pipeline/data/measurements.hpp"

namespace crisp {

/// Angles and firing times of a scan's beams.
struct BeamSequence {
  double first_angle = 0;  ///< [rad] of beam 0: reported angle less mount
  double angle_step = 0;   ///< [rad]
  double first_time = 0;   ///< [s since the epoch] of beam 0
  double interval = 0;     ///< [s]
  std::uint16_t laser = 0;
};

/// Adds the beams that came back.
/// @param ranges      [m], 0 where there is no echo
/// @param remissions  as many, or none
void append_beams(const BeamSequence& sequence, std::span<const float> ranges,
                  std::span<const float> remissions, Measurements& to);

}  // namespace crisp
