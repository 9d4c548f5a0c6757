// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "grabbers/simulate/measurements.hpp"
#include "pipeline/estimate/sample.hpp"

namespace crisp::test {

/// Recordings of one scanner, a minute apart.
struct Several {
  Measurements beams;
  PlateTrajectory plate;

  estimate::Sample sample() const { return {.beams = beams, .plate = &plate}; }
};

/// @param new_zeros  whether the encoder began to count anew each time: angles are then off by any amount
inline Several several(const std::vector<simulate::SimulatedMeasurements>& recordings,
                       bool new_zeros = false) {
  constexpr double kApart = 60;  // [s]
  constexpr double kZero = 1.3;  // [rad]
  Several all;
  std::vector<double> times;
  std::vector<double> angles;
  std::vector<double> zeros;
  all.beams.epoch_ns = recordings.front().beams.epoch_ns;
  for (std::size_t k = 0; k < recordings.size(); ++k) {
    const double later = kApart * static_cast<double>(k);
    Measurements beams = recordings[k].beams;
    for (double& time : beams.time) time += later;
    all.beams.append(beams);
    const PlateTrajectory& plate = recordings[k].plate;
    for (const double time : plate.times()) times.push_back(time + later);
    for (const double angle : plate.angles()) {
      angles.push_back(angle + (new_zeros ? kZero * static_cast<double>(k) : 0));
    }
    if (new_zeros && k > 0) zeros.push_back(plate.begin() + later);
  }
  all.plate = PlateTrajectory(all.beams.epoch_ns, times, angles, recordings.front().plate.max_gap(), zeros);
  return all;
}

}  // namespace crisp::test
