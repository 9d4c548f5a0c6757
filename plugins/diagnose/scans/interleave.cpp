// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/diagnose/scans/interleave.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "plugins/diagnose/scans/lag_contrast.hpp"
#include "plugins/diagnose/scans/stationary_profiles.hpp"

namespace crisp::diagnose {
namespace {

constexpr double kStillDiffers = 0.2;  // largest share of the contrast at the period

/// The smallest lag without most of the contrast.
std::size_t period_of(const std::vector<double>& difference) {
  const double contrast = contrast_of(difference);
  double least = std::numeric_limits<double>::infinity();
  for (const double d : difference) least = std::fmin(least, d);
  for (std::size_t l = 0; l < difference.size(); ++l) {
    if (difference[l] - least <= kStillDiffers * contrast) return l + 1;
  }
  return 1;
}

}  // namespace

ScanInterleave find_interleave(const std::vector<SeriesScan>& scans, std::uint64_t seed) {
  std::vector<std::vector<double>> rows;
  std::vector<std::int64_t> counts;
  for (const auto& scan : std::span(scans).first(std::min(kEnoughStationary, scans.size()))) {
    rows.push_back(row_of(scan));
    counts.push_back(scan.count);
  }
  const LagContrast lags(std::move(rows), counts);
  const auto chance = lags.permutation_test(seed);
  ScanInterleave found{.difference = lags.difference(),
                       .period = period_of(lags.difference()),
                       .p_value = chance.p_value,
                       .beyond_chance = std::max(0.0, lags.contrast() - chance.mean)};
  constexpr double kSure = 0.01;
  if (found.p_value > kSure) found.period = 1;
  return found;
}

std::size_t reference_class(const std::vector<SeriesScan>& scans, std::size_t period) {
  std::size_t best = 0;
  std::size_t most = 0;
  for (const auto& scan : scans) {
    if (scan.ranges().size() <= most) continue;
    most = scan.ranges().size();
    best = class_of(scan, period);
  }
  return best;
}

}  // namespace crisp::diagnose
