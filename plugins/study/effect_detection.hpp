// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "grabbers/simulate/measurements.hpp"
#include "plugins/diagnose/model/effect_resolution.hpp"

namespace crisp::study {

/// Which effects a recording would show, and from which size on: see EffectResolution.
struct EffectDetection {
  std::vector<diagnose::EffectResolution> effects;  ///< by laser and cause
  std::size_t beams = 0;                            ///< on flat surfaces, that the diagnosis tests with
  std::size_t surfaces = 0;                         ///< that they meet
};

/// The effects that a diagnosis could find in a recording of the scanner at a scene, which is simulated, with
/// the surfaces that the diagnosis would find there.
///
/// @param motion  of the plate, in place of `scanner.motion`
/// @throws Error  if no beam meets a flat surface, or the settings make no sense
EffectDetection effect_detection(const simulate::ScannerSettings& scanner, const simulate::Scene& scene,
                                 const simulate::Motion& motion, const TermRegistry& terms);

/// A table for people, a line an effect.
std::string effects_text(const EffectDetection& bound);
std::string effects_csv(const EffectDetection& bound);

}  // namespace crisp::study
