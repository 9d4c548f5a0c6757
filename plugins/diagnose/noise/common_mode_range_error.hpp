// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <crisp/findings.hpp>

#include "pipeline/plot/plot.hpp"
#include "plugins/diagnose/noise/noise_model.hpp"

namespace crisp::diagnose {

/// Common-mode change of a stationary laser's ranges with a known cause: a step or a warm-up drift.
struct CommonModeChange {
  bool is_step = true;  ///< otherwise a warm-up drift: c (1 − exp(−t/T))
  double size = 0;      ///< [m]
  double std_error = 0;
  double shape = 0;  ///< [s] time of the step since the run's epoch, or time constant T
  double shape_error = 0;
  double p_value = 1;
  double log10_bayes_factor =
      0;  ///< log10 of the Bayes factor (BIC) against the best model without the change
  Gain gain;
};

/// Slow common-mode wander of a stationary laser's ranges, of unknown cause.
struct CommonModeWander {
  double rms = 0;  ///< [m]
  double p_value = 1;
  Gain gain;
};

/// Common-mode range error of a stationary laser.
struct CommonModeError {
  std::optional<CommonModeChange> change;
  std::optional<CommonModeWander> wander;
  Eigen::VectorXd curve;  ///< [m] change and wander per scan, centred; empty if there is neither
  Eigen::VectorXd named;  ///< [m] the change alone; empty if there is none
};

/// Detects a common-mode step, warm-up drift or wander in the mean range error of each scan, weighted by each
/// beam's noise. The models are a step at each instant, warm-ups of several time constants, two to eight
/// cosines over the recording, and cosines with a change. BIC selects among them.
///
/// @param errors   with the scan's number as `block`
/// @param seconds  [s] receipt time of each scan
/// @return  the parts that are significant at p < 0.002
CommonModeError common_mode_error(const RangeErrors& errors, const std::vector<double>& seconds,
                                  std::size_t tests, std::uint64_t seed);

/// Plot of each scan's mean error with the fitted curve.
plot::Plot common_plot(const std::string& name, const CommonModeError& found, const RangeErrors& errors,
                       const std::vector<double>& seconds);

/// Subtracts a curve [m], given per scan, from the range errors.
void subtract_curve(const Eigen::VectorXd& curve, RangeErrors& errors);

}  // namespace crisp::diagnose
