// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>

#include <crisp/findings.hpp>

#include "pipeline/clocks/envelope.hpp"

namespace crisp::diagnose {

/// A clock whose rate changes smoothly: the general member of the family of clock.drift, a polynomial of the
/// minimum delays over time.
struct ClockCurve {
  Eigen::VectorXd delay;  ///< [s] about the clock of constant rate, at each stretch of the envelope
  double size = 0;        ///< [s] RMS
  double std_error = 0;   ///< [s] of the size
  double squares = 0;     ///< [s²] sum of what it leaves
  Eigen::Index parameters = 0;
  Gain gain;  ///< see gain_in_series()
};

/// The polynomial of second to twelfth order with the least BIC. Nothing where it leaves more than
/// neighbouring minimum delays differ by: then their course is not smooth.
std::optional<ClockCurve> smooth_curve(const clocks::Envelope& envelope, std::uint64_t seed);

}  // namespace crisp::diagnose
