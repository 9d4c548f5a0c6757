// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "pipeline/data/findings.hpp"

namespace crisp {

/// Whether ranges are multiples of a step that is larger than the telegram's millimetre (noise.quantisation):
/// from the spectrum of their distribution, which a comb gives a line.
///
/// @param ranges  [m] as the laser reported them, over some metres
/// @param block   of each: what is drawn together for the confidence interval
/// @return  steps of 1.5 to 50 mm that are significant beyond 0.002, with the gain over no comb
std::optional<Finding> quantisation(const std::string& scope, std::span<const float> ranges,
                                    std::span<const std::uint32_t> block, std::uint64_t seed);

}  // namespace crisp
