// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "plugins/scans/scan_series.hpp"

namespace crisp {

inline std::size_t kind_of(const SeriesScan& scan, std::size_t period) {
  const auto p = static_cast<std::int64_t>(period);
  return static_cast<std::size_t>(((scan.count % p) + p) % p);
}

/// Mean ranges of scans of one kind, beam by beam [m]; NaN where fewer than half of the scans have an echo.
/// What is farther from the median than 0.1 m does not count.
std::vector<double> mean_profile(const std::vector<SeriesScan>& scans);
std::vector<double> mean_profile(const std::vector<std::vector<double>>& rows);

/// Ranges [m] of a scan; NaN where there is no echo.
std::vector<double> row_of(const SeriesScan& scan);

/// The profile between its beams, straight from one to the next; NaN beyond it.
double at_beam(const std::vector<double>& profile, double beam);

}  // namespace crisp
