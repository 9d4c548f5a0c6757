// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace crisp {

/// How scans come in, against the even rate at which they were taken.
struct Bursts {
  double interval = 0;        ///< [s] mean time between two scans, as they were taken
  double together = 0;        ///< share of the scans that came within a quarter of that after the one before
  double together_error = 0;  ///< standard error
  double wait = 0;            ///< [s] standard deviation of receipt less stamp
  double longest = 0;         ///< [s] most that a scan came later than the least late one
  double p_value = 1;         ///< that delays independent of one another make as many come together
};

/// @param receipts  [s] of scans
/// @param stamps    [s] of the same on the same clock but for a constant
/// Delays that are independent of one another already make some come together: the p-value is from shuffled
/// delays.
Bursts find_bursts(const std::vector<double>& receipts, const std::vector<double>& stamps,
                   std::uint64_t seed);

}  // namespace crisp
