// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "grabbers/simulate/measurements.hpp"

namespace crisp::study {

/// The beams of its lasers that a study uses.
enum class BeamChoice {
  kAll,      ///< the whole field of view
  kInPlane,  ///< of each laser the two that lie in the plate's plane, θ = ±90°, or as near as its step allows
};

/// simulate_measurements() of these beams alone.
/// @throws Error if the beams in the plate's plane are wanted and a laser's field of view has none
simulate::SimulatedMeasurements simulate_beams(BeamChoice beams, simulate::ScannerSettings scanner,
                                               const simulate::Scene& scene, const simulate::Motion& motion,
                                               const TermRegistry& terms = {});

}  // namespace crisp::study
