// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <memory>
#include <numbers>

#include <crisp/measure.hpp>

#include "grabbers/simulate/measurements.hpp"
#include "grabbers/simulate/scenes.hpp"
#include "pipeline/data/degree.hpp"
#include "pipeline/estimate/sample.hpp"

namespace crisp {

/// A recording in the office whose truth is off the nominal rig by up to 2 cm, 3°, 5° (λ) and 40 ms.
inline simulate::ScannerSettings misplaced_scanner(std::uint64_t seed, double duration) {
  simulate::ScannerSettings scanner;
  scanner.seed = seed;
  scanner.duration = duration;
  for (std::size_t i = 0; i < scanner.truth.lasers.size(); ++i) {
    LaserCalibration& laser = scanner.truth.lasers[i];
    // A low-discrepancy spread over the box, different for each seed.
    const auto at = [&](double irrational) {
      const double u = static_cast<double>(seed * scanner.truth.lasers.size() + i + 1) * irrational;
      return 2 * (u - std::floor(u)) - 1;
    };
    if (i > 0) laser.lambda.value += 5 * data::kDegree * at(std::numbers::phi);
    laser.tau.value += 0.02 * at(std::numbers::sqrt2);
    laser.alpha.value += 3 * data::kDegree * at(std::numbers::sqrt3);
    laser.eta.value += 0.04 * at(std::numbers::e);
  }
  return scanner;
}

inline std::unique_ptr<Measure> rqe_measure() {
  SearchRegistry searches;
  register_built_in(searches);
  MeasureRegistry measures;
  register_built_in(measures);
  return measures.make("rqe", {.search = "grid", .cutoff = 5}, searches);
}

inline estimate::Sample sample_of(const simulate::SimulatedMeasurements& simulated) {
  return {.beams = simulated.beams, .plate = &simulated.plate};
}

/// All of λ, τ, α, η of three lasers but the gauge λ₁.
inline std::vector<std::size_t> all_free() { return {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11}; }

}  // namespace crisp
