// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <crisp/findings.hpp>

namespace crisp::diagnose {

/// Held-out gain of one noise model over another: mean difference of the log-likelihood per range.
///
/// @param before, after  ln of the density of each range under either model, fitted to other ranges
/// @param block          resampling unit of each range for the confidence interval (block bootstrap)
Gain likelihood_gain(const std::vector<double>& before, const std::vector<double>& after,
                     const std::vector<std::uint32_t>& block, std::uint64_t seed);

/// Sets the share of each finding and unnamed finding of one laser in the held-out log-likelihood gain of all
/// of them. Findings that were judged by another metric stay as they are.
void share_explained(std::span<Finding> findings, std::span<const UnnamedFinding> unnamed);

}  // namespace crisp::diagnose
