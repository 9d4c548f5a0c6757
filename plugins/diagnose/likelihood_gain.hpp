// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "pipeline/data/findings.hpp"

namespace crisp {

/// By how much one law of ranges says more of them than another, a range.
///
/// @param before, after  ln of the density of each range under either law, fitted to others
/// @param block          of each range: what is drawn together for the confidence interval (bootstrap)
Gain likelihood_gain(const std::vector<double>& before, const std::vector<double>& after,
                     const std::vector<std::uint32_t>& block, std::uint64_t seed);

}  // namespace crisp
