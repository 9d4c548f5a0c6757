// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace crisp {

/// Counts by which scans at rest are compared; more is another rest.
inline constexpr std::size_t kMostLags = 8;

/// By how much more scans at rest differ some counts apart than other counts apart. Differences count up to
/// 0.3 m, so that edges do not outweigh all else; counts up to kMostLags apart are looked at.
class LagContrast {
 public:
  /// @param rows    of each scan its ranges [m], or what a model leaves of them; NaN where there is none
  /// @param counts  of the scans, rising; what is farther apart is another rest, and is not compared
  LagContrast(std::vector<std::vector<double>> rows, const std::vector<std::int64_t>& counts);

  /// [m] Element l − 1: mean size of the difference between scans l apart; NaN where there are none.
  const std::vector<double>& difference() const { return difference_; }
  double contrast() const;  ///< [m] the largest of these less the least

  /// What scans in random order make of it, each within its rest: if all are alike, any order is as likely.
  struct Chance {
    double p_value = 1;   ///< that the contrast is as large
    double contrast = 0;  ///< [m] mean
  };
  /// @param kinds  of the scans: only those of one kind are alike; empty: all are
  Chance shuffled(std::uint64_t seed, const std::vector<std::size_t>& kinds = {}) const;

 private:
  struct Pair {
    std::size_t first, second, lag;
  };
  /// @param between  [m] mean size of the difference of two scans
  template <class Between>
  std::vector<double> by_lag(const Between& between) const;
  std::vector<double> matrix() const;
  std::vector<std::vector<std::size_t>> groups(const std::vector<std::size_t>& kinds) const;

  std::vector<std::vector<double>> rows_;
  std::vector<std::size_t> rests_;  ///< where each begins, and where the last one ends
  std::vector<Pair> pairs_;
  std::vector<double> difference_;
};

/// The largest number less the least; 0 of none.
double contrast_of(const std::vector<double>& by_lag);

}  // namespace crisp
