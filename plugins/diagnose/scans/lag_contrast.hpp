// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "pipeline/statistics/monte_carlo_test.hpp"

namespace crisp::diagnose {

/// Largest lag between compared stationary scans; a larger gap separates stationary phases.
inline constexpr std::size_t kMaxLags = 8;

/// Contrast of the differences between stationary scans over their lag. Differences are clipped at 0.3 m, so
/// that edges do not dominate.
class LagContrast {
 public:
  /// @param rows    ranges [m] of each scan, or residuals of a model; NaN without an echo
  /// @param counts  of the scans, ascending; a gap above kMaxLags separates stationary phases
  LagContrast(std::vector<std::vector<double>> rows, const std::vector<std::int64_t>& counts);

  /// [m] Element l − 1: mean absolute difference of scans at lag l; NaN without pairs.
  const std::vector<double>& difference() const { return difference_; }
  double contrast() const;  ///< [m] largest less smallest difference

  /// Permutation test of the contrast [m]: permutes the scans' order within each stationary phase.
  /// @param kinds  scan class of each scan, within which scans are exchangeable; empty: one class
  statistics::MonteCarloTest permutation_test(std::uint64_t seed,
                                              const std::vector<std::size_t>& kinds = {}) const;

 private:
  struct Pair {
    std::size_t first, second, lag;
  };
  /// @param between  [m] mean absolute difference of two scans
  template <class Between>
  std::vector<double> by_lag(const Between& between) const;
  std::vector<double> matrix() const;
  std::vector<std::vector<std::size_t>> groups(const std::vector<std::size_t>& kinds) const;

  std::vector<std::vector<double>> rows_;
  std::vector<std::size_t> phases_;  ///< start of each stationary phase, and end of the last one
  std::vector<Pair> pairs_;
  std::vector<double> difference_;
};

/// The largest number less the smallest; 0 without numbers.
double contrast_of(const std::vector<double>& by_lag);

}  // namespace crisp::diagnose
