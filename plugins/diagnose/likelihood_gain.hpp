// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "pipeline/data/findings.hpp"

namespace crisp {

/// By how much one law of ranges says more of them than another, a range.
///
/// @param before, after  ln of the density of each range under either law, fitted to others
/// @param block          of each range: what is drawn together for the confidence interval (bootstrap)
Gain likelihood_gain(const std::vector<double>& before, const std::vector<double>& after,
                     const std::vector<std::uint32_t>& block, std::uint64_t seed);

/// Says of each law that was found of one laser's ranges which share it has in what all of them raise the
/// log-likelihood of a range that they were not fitted to. Findings that were judged by something else are
/// left as they are.
void share_explained(std::span<Finding> findings, std::span<const UnnamedFinding> unnamed);

}  // namespace crisp
