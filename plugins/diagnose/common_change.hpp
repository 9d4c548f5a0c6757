// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "pipeline/data/findings.hpp"
#include "pipeline/plot/plot.hpp"
#include "plugins/diagnose/noise_law.hpp"

namespace crisp {

/// A change of all ranges of a laser at rest that has a name.
struct CommonChange {
  bool is_step = true;  ///< else it creeps: c (1 − exp(−t/T))
  double size = 0;      ///< [m]
  double std_error = 0;
  double shape = 0;  ///< [s] when it steps, by the scans' own seconds; or T
  double shape_error = 0;
  double p_value = 1;
  double log10_odds = 0;  ///< against the next likely way without it, by BIC
  Gain gain;
};

/// A slow wander of all ranges, which has none.
struct CommonWander {
  double rms = 0;  ///< [m]
  double p_value = 1;
  Gain gain;
};

/// What all beams of a laser at rest do at once.
struct DoneTogether {
  std::optional<CommonChange> change;
  std::optional<CommonWander> wander;
  Eigen::VectorXd curve;  ///< [m] of both, scan by scan, about 0; empty if there is neither
  Eigen::VectorXd named;  ///< [m] of the change alone; empty if there is none
};

/// Looks for a jump of all ranges, their creeping, or their wander, scan by scan: the mean error of a scan's
/// beams, each by how little it scatters, is tried against a step at each instant, warm-ups of several time
/// constants, two to eight cosines over the recording, and these with a step. BIC chooses.
///
/// @param errors   with the number of the scan as `block`
/// @param seconds  [s] when each scan came in
/// @return  what is significant beyond 0.002
DoneTogether done_together(const RangeErrors& errors, const std::vector<double>& seconds, std::size_t looks,
                           std::uint64_t seed);

/// The mean error of each scan beside the curve that was found in it.
Plot common_plot(const std::string& name, const DoneTogether& found, const RangeErrors& errors,
                 const std::vector<double>& seconds);

/// Takes a curve [m], scan by scan, out of the ranges' errors.
void take_out(const Eigen::VectorXd& curve, RangeErrors& errors);

}  // namespace crisp
