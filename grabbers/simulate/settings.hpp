// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <vector>

#include <crisp/calibration.hpp>
#include <crisp/rig.hpp>

#include "grabbers/simulate/mirror_rotation.hpp"
#include "grabbers/simulate/motion.hpp"
#include "grabbers/simulate/noise.hpp"

namespace crisp::simulate {

/// Which beams a laser reports, by their reported angles: first, first + step, … last.
struct FieldOfView {
  double first = -45 * std::numbers::pi / 180;  ///< [rad]
  double last = 225 * std::numbers::pi / 180;   ///< [rad]
  double step = 0.5 * std::numbers::pi / 180;   ///< [rad]

  /// @throws Error if the step is not positive, or the field is empty or wider than a turn
  std::size_t beams() const;

  double angle_of(std::size_t beam) const { return first + static_cast<double>(beam) * step; }  ///< [rad]
};

/// Scan pattern of a laser of a kind of its own.
struct ScanPattern {
  FieldOfView field;
  double frequency = 50;  ///< [Hz] nominal rate of the mirror
};

/// Scans of several kinds that take turns: `mirror.interleave` of the catalogue.
struct Interleave {
  double shift = 0;   ///< [rad] by which the beams of one kind point further
  double period = 0;  ///< scans after which kinds are alike again; 0: all are
  double kind = 0;    ///< which one it is: the scan's number modulo the period

  /// [rad] by which the beams of a scan point further.
  double of(std::uint64_t scan) const {
    return period >= 1 && std::fmod(static_cast<double>(scan), period) == kind ? shift : 0;
  }
};

/// Deviations of one laser from the others of its kind, beyond the true calibration.
struct LaserEffects {
  NoiseEffects noise;
  double mirror_wander = 0;  ///< RMS of slow changes of its mirror's period, as a share; 0: of its kind
  Interleave interleave;
  double mirror_excess = 0;  ///< [s] of its mirror's mean period over the nominal one; 0: as drawn
  bool mirror_drawn = true;  ///< false: an excess of 0 is one of 0
};

/// Settings of the simulated scanner. Lasers are of one kind unless `patterns` differ; their mirrors, clocks
/// and noise are their own.
struct ScannerSettings {
  Rig rig = default_rig();
  Calibration truth = nominal_calibration(default_rig());  ///< one laser each of the rig, in its order
  MirrorSettings mirror;
  FieldOfView field;
  std::vector<ScanPattern> patterns;  ///< one a laser, before `field` and the mirror's frequency; empty: none
  std::vector<std::uint16_t> beams;   ///< indices of the only beams to fire; empty: all
  RangeSettings range;
  std::vector<LaserEffects> laser_effects;  ///< one a laser; empty: none
  MotionSettings motion;
  double plate_frequency = 500;   ///< [Hz] rate of encoder readings
  bool encoder_quantised = true;  ///< whole counts, as the encoder reports them; false: exact angles
  double duration = 10;           ///< [s]
  std::uint64_t seed = 1;

  ScanPattern pattern_of_all() const { return {.field = field, .frequency = mirror.frequency}; }

  /// Scan pattern of one laser.
  ScanPattern pattern_of(std::size_t laser) const {
    return patterns.empty() ? pattern_of_all() : patterns.at(laser);
  }

  /// The effects of one laser, whether there are any or not.
  LaserEffects effects_of(std::size_t laser) const {
    return laser_effects.empty() ? LaserEffects{} : laser_effects.at(laser);
  }
};

/// @throws Error if the plate reports no reading
void check_plate_frequency(const ScannerSettings& settings);

}  // namespace crisp::simulate
