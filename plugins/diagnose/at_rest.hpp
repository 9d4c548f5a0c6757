// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "pipeline/data/scan.hpp"
#include "pipeline/plot/plot.hpp"
#include "plugins/diagnose/noise.hpp"

namespace crisp {

/// The scans of one laser that stands still: the same beams again and again.
class AtRest {
 public:
  /// A scan with another number of beams than the first is left out.
  void add(const Scan& scan);
  std::size_t scans() const { return receipt_ns_.size(); }

  /// By how much each range is off the mean of its beam. Beams that seldom come back, and those along edges,
  /// are left out: those that scatter by more than 3 cm.
  ///
  /// @return  nothing if hardly a beam stays the same: the laser, or all before it, moves
  std::optional<RangeErrors> errors() const;

  std::int64_t receipt_ns(std::size_t scan) const { return receipt_ns_[scan]; }
  std::size_t left_out() const { return left_out_; }

 private:
  std::size_t beams_ = 0;
  std::vector<float> ranges_;  // [m] scan by scan
  std::vector<std::int64_t> receipt_ns_;
  std::size_t left_out_ = 0;
};

/// What all beams of a laser at rest do at once.
struct CommonChange {
  bool is_step = true;  ///< else it creeps: c (1 − exp(−t/T))
  double size = 0;      ///< [m]
  double std_error = 0;
  double shape = 0;  ///< [s] since the first scan: when it steps; or T
  double shape_error = 0;
  double p_value = 1;
  double log10_odds = 0;  ///< against the next likely of: a step, a creeping, neither; by BIC
  Gain gain;
};

/// Looks for a jump of all ranges, or their creeping, scan by scan: the mean error of a scan's beams is tried
/// against a step at each instant and against warm-ups of several time constants.
///
/// @param errors   with the number of the scan as `block`
/// @param seconds  [s] when each scan came in
/// @return  what is significant beyond 0.002
std::optional<CommonChange> common_change(const RangeErrors& errors, const std::vector<double>& seconds,
                                          std::size_t looks, std::uint64_t seed);

/// The mean error of each scan beside the change that was found in it.
Plot change_plot(const std::string& name, const CommonChange& change, const RangeErrors& errors,
                 const std::vector<double>& seconds);

/// Takes it out of the ranges' errors.
void take_out(const CommonChange& change, const std::vector<double>& seconds, RangeErrors& errors);

}  // namespace crisp
