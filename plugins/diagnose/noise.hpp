// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "pipeline/data/findings.hpp"
#include "plugins/diagnose/noise_law.hpp"

namespace crisp {

/// What the ranges of one laser show: the law that BIC asks for, forward from the normal one.
struct NoiseDiagnosis {
  NoiseLaw plain;  ///< normal
  NoiseLaw law;
  std::vector<Finding> findings;        ///< one for each way in which it is not normal
  std::vector<UnnamedFinding> unnamed;  ///< beams that scatter each by another amount
};

/// @param scope       the laser's name
/// @param all         at least some hundred ranges; of very many, some blocks count
/// @param least_gain  [nat] a range, on those held out: what brings less is not spoken of
NoiseDiagnosis diagnose_noise(const std::string& scope, const RangeErrors& all, std::uint64_t seed,
                              double least_gain = 0);

}  // namespace crisp
