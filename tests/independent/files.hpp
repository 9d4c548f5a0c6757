// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "tests/independent/effects.hpp"
#include "tests/independent/population.hpp"

namespace independent {

/// Writes the rig file with the user's values (docs/how-to/describe-a-rig.md), faults included.
void write_rig(const std::string& path, const Setup& setup);

/// Results of a simulation.
struct Outcome {
  std::string arguments;                ///< that draw the same capture again
  double turns = 0;                     ///< range of the plate's angle [turns]
  double slowest = 0, fastest = 0;      ///< of the plate's rates, without their signs [turns/s]
  double smallest_plate_delay = 0;      ///< [s] of any datagram
  std::vector<double> smallest_delays;  ///< [s] of any telegram, for each laser
  std::vector<std::size_t> scans;
  double effect_rms = 0;  ///< [m]
};

/// Writes the truth: one line a laser, in rad, m and s.
///
/// `eta` follows from the links' minimum delays. `eta_sample` follows from the smallest delays that occurred
/// in this capture: a lower envelope of the delays can determine no more.
void write_truth(const std::string& path, const Setup& setup, const Effect& effect, const Outcome& outcome);

}  // namespace independent
