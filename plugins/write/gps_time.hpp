// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>

namespace crisp::write {

/// Adjusted standard GPS time [s] of an instant: seconds since 1980-01-06, with leap seconds, less 10^9.
/// Nothing before that day.
/// @param unix_us  [µs since the Unix epoch]
std::optional<double> adjusted_gps_time(std::uint64_t unix_us);

}  // namespace crisp::write
