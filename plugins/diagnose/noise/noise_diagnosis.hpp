// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <crisp/findings.hpp>

#include "plugins/diagnose/noise/noise_model.hpp"

namespace crisp::diagnose {

/// Noise model of one laser, selected forward by BIC from the normal one.
struct NoiseDiagnosis {
  NoiseModel plain;  ///< normal
  NoiseModel model;
  std::vector<Finding> findings;        ///< one per identified noise component
  std::vector<UnnamedFinding> unnamed;  ///< noise that differs between beams
};

/// Selects, cross-validates and estimates the noise components of one laser.
///
/// @param scope       the laser's name
/// @param all         at least some hundred ranges; large samples are reduced to some blocks
/// @param least_gain  [nat] minimum held-out gain per range
NoiseDiagnosis diagnose_noise(const std::string& scope, const RangeErrors& all, std::uint64_t seed,
                              double least_gain = 0);

}  // namespace crisp::diagnose
