// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <random>
#include <vector>

#include "tests/independent/effects.hpp"
#include "tests/independent/motion.hpp"
#include "tests/independent/population.hpp"
#include "tests/independent/world.hpp"

namespace independent {

/// A laser's mirror: its turns over time, at a speed below nominal that wanders within seconds.
class Mirror {
 public:
  /// @param nominal   [Hz]
  /// @param slowness  share by which the mirror's mean speed is below nominal
  /// @param wander    largest relative departure of the speed from its mean
  Mirror(double nominal, double slowness, double wander, std::mt19937_64& random);

  double turns(double time) const;
  double time_of(double requested) const;  ///< inverse of turns(), by Newton's method

 private:
  double rate(double time) const;

  struct Wave {
    double size, pulsation, phase;
  };
  double mean_, start_;
  std::vector<Wave> waves_;
};

/// One sweep as a laser reports it.
struct Scan {
  double stamp = 0;                   ///< hub time of the scan's time stamp [s]
  double transmission = 0;            ///< hub time at which the device hands the scan out [s]
  std::vector<std::uint16_t> ranges;  ///< [mm], 0: no echo
  std::vector<std::uint8_t> remissions;
};

Pose plate_pose(const Setup& setup);

/// All scans of a laser (its index) that begin and end within the capture, each beam fired at its own
/// instant.
std::vector<Scan> simulate_scans(const Setup& setup, std::size_t index, const World& world,
                                 const PlateMotion& motion, const Effect& effect, std::mt19937_64 random);

/// RMS by which the effect changes what beams measure, against a plain scanner that reports the same times
/// and angles [m]. Beams drawn at random; those that it moves across an edge do not count.
double effect_rms(const Setup& setup, const World& world, const PlateMotion& motion, const Effect& effect,
                  std::mt19937_64 random);

}  // namespace independent
