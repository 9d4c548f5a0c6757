// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <crisp/calibration.hpp>
#include <crisp/measurements.hpp>
#include <crisp/plate_trajectory.hpp>
#include <crisp/term.hpp>

#include "grabbers/simulate/motion.hpp"
#include "grabbers/simulate/scene.hpp"
#include "grabbers/simulate/settings.hpp"

namespace crisp::simulate {

/// A recording's measurements with perfectly aligned clocks.
struct SimulatedMeasurements {
  Measurements beams;
  std::vector<std::uint32_t> surface;  ///< for each beam, the index of the scene's thing that it met
  std::vector<float> cos_incidence;    ///< of each beam on it, which `beams` does not contain
  PlateTrajectory plate;    ///< reaches 0.25 s beyond the beams at both ends, so that any lag is covered
  Calibration truth;        ///< of which the beams were made
  std::size_t no_echo = 0;  ///< beams that nothing came back from
};

/// Simulates measurements without clocks, telegrams or delays: times are hub times whose only error is the η
/// of the true calibration, φ_j = φ(t_j + η).
///
/// @param terms     with the ones that `settings.truth` names
/// @param terms     that `settings.truth` names
/// @throws Error    if the settings are inconsistent
SimulatedMeasurements simulate_measurements(const ScannerSettings& settings, const Scene& scene,
                                            const TermRegistry& terms = {});

/// The same with a motion of the plate [true time, s] of one's own instead of `settings.motion`.
SimulatedMeasurements simulate_measurements(const ScannerSettings& settings, const Scene& scene,
                                            const Motion& motion, const TermRegistry& terms = {});

}  // namespace crisp::simulate
