// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <numbers>
#include <vector>

#include "grabbers/simulate/mirror.hpp"
#include "grabbers/simulate/motion.hpp"
#include "pipeline/data/calibration.hpp"
#include "pipeline/data/rig.hpp"

namespace crisp {

/// What a laser makes of a true distance. The defaults are those of the LMS-151's data sheet.
struct RangeSettings {
  double sigma = 0.012;      ///< [m] standard deviation of the noise
  double quantum = 0.001;    ///< [m] ranges are multiples of it; 0: not rounded
  double max_distance = 50;  ///< [m] nothing comes back from beyond
};

/// Which beams a laser reports, by their reported angles: first, first + step, … last.
struct FieldOfView {
  double first = -45 * std::numbers::pi / 180;  ///< [rad]
  double last = 225 * std::numbers::pi / 180;   ///< [rad]
  double step = 0.5 * std::numbers::pi / 180;   ///< [rad]

  /// @throws Error if the step is not positive, or the field is empty or wider than a turn
  std::size_t beams() const;
};

/// The scanner to simulate: what is true of it. All lasers are of one kind; their mirrors, clocks and noise
/// are their own.
struct ScannerSettings {
  Rig rig = default_rig();
  Calibration truth = nominal_calibration(default_rig());  ///< one laser each of the rig, in its order
  MirrorSettings mirror;
  FieldOfView field;
  std::vector<std::uint16_t> beams;  ///< indices of the only beams to fire; empty: all
  RangeSettings range;
  MotionSettings motion;
  double plate_frequency = 500;   ///< [Hz] encoder readings a second
  bool encoder_quantised = true;  ///< whole counts, as the encoder reports them; false: exact angles
  double duration = 10;           ///< [s]
  std::uint64_t seed = 1;
};

}  // namespace crisp
