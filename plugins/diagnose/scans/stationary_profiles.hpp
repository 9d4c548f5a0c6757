// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "plugins/diagnose/scans/scan_series.hpp"

namespace crisp::diagnose {

/// Scan class of a scan: its count modulo the period.
inline std::size_t class_of(const SeriesScan& scan, std::size_t period) {
  const auto p = static_cast<std::int64_t>(period);
  return static_cast<std::size_t>(((scan.count % p) + p) % p);
}

/// Mean range [m] per beam of scans of one class; NaN where fewer than half of the scans have an echo. Ranges
/// more than 0.1 m from the median are left out.
std::vector<double> mean_profile(const std::vector<SeriesScan>& scans);
std::vector<double> mean_profile(const std::vector<std::vector<double>>& rows);

/// Ranges [m] of a scan; NaN where there is no echo.
std::vector<double> row_of(const SeriesScan& scan);

/// The profile at a fractional beam index, interpolated linearly; NaN outside.
double at_beam(const std::vector<double>& profile, double beam);

}  // namespace crisp::diagnose
