// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <memory>
#include <vector>

#include "grabbers/simulate/measurements.hpp"
#include "grabbers/simulate/scenes.hpp"
#include "pipeline/data/degree.hpp"
#include "plugins/calibrate/watch/sliding_window.hpp"

namespace crisp::test {

/// Some seconds in the office, of a scanner with the default rig's values and lags of its own.
inline simulate::SimulatedMeasurements recorded(double seconds) {
  simulate::ScannerSettings scanner;
  scanner.duration = seconds;
  scanner.truth.lasers[1].eta.value = 2e-3;
  return simulate::simulate_measurements(scanner, simulate::office());
}

/// The second laser was pushed: its mount is off by `aside`.
inline Calibration pushed(Calibration calibration, double aside = 0.5 * data::kDegree) {
  calibration.lasers[1].alpha.value += aside;
  return calibration;
}

/// The recording as a live pipeline would hand it out: batches of some hundredths of a second.
inline std::vector<calibrate::SlidingWindow::Batch> batches_of(
    const simulate::SimulatedMeasurements& simulated) {
  constexpr std::size_t kBatch = 2000;
  const auto plate = std::make_shared<const PlateTrajectory>(simulated.plate);
  std::vector<calibrate::SlidingWindow::Batch> batches;
  for (std::size_t begin = 0; begin < simulated.beams.size(); begin += kBatch) {
    auto beams = std::make_shared<Measurements>();
    beams->epoch_ns = simulated.beams.epoch_ns;
    const std::size_t end = std::min(begin + kBatch, simulated.beams.size());
    for (std::size_t i = begin; i < end; ++i) beams->append(simulated.beams, i);
    batches.push_back({std::move(beams), plate});
  }
  return batches;
}

}  // namespace crisp::test
