// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include <crisp/findings.hpp>

namespace crisp::diagnose {

/// Detects range quantization coarser than the telegram's millimetre (noise.quantisation): a line in
/// the spectrum of the ranges' distribution.
///
/// @param ranges  [m] as reported by the laser, over some metres
/// @param block   resampling unit of each range for the confidence interval (block bootstrap)
/// @return  a step of 1.5 to 50 mm that is significant at p < 0.002, with its gain over unquantized ranges
std::optional<Finding> range_quantization(const std::string& scope, std::span<const float> ranges,
                                          std::span<const std::uint32_t> block, std::uint64_t seed);

}  // namespace crisp::diagnose
