// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace crisp::diagnose {

/// Bursts in the receipt times of scans that were taken at even intervals.
struct Bursts {
  double interval = 0;        ///< [s] mean interval between scans, by their stamps
  double together = 0;        ///< share of scans received within a quarter interval after the previous one
  double together_error = 0;  ///< standard error
  double wait = 0;            ///< [s] standard deviation of receipt less stamp
  double longest = 0;         ///< [s] largest delay relative to the smallest
  double p_value = 1;         ///< permutation test against independent delays
};

/// Tests for bursts by a permutation test of the delays: independent delays also bring some scans together.
///
/// @param receipts  [s] receipt times of the scans
/// @param stamps    [s] their stamps on the same clock, up to a constant
Bursts find_bursts(const std::vector<double>& receipts, const std::vector<double>& stamps,
                   std::uint64_t seed);

}  // namespace crisp::diagnose
