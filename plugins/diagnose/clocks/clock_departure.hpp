// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <crisp/findings.hpp>

#include "plugins/diagnose/clocks/clock_stamps.hpp"

namespace crisp::diagnose {

/// Deviation of a clock or its link from the clock model: a constant rate and a constant minimum delay.
struct ClockDeparture {
  /// varying_drift: see ClockCurve. backlog: queued telegrams arrive late, ever less so until the queue is
  /// empty.
  enum class Kind { drift, varying_drift, clock_step, latency_step, backlog };
  Kind kind = Kind::drift;
  /// drift: [1/s] of the skew; varying drift: [s] RMS of delays about the clock; steps: [s] forward, or
  /// later; backlog: [s] RMS
  double size = 0;
  double std_error = 0;  ///< of the size
  double skew = 0;       ///< at the first stamp
  double skew_std_error = 0;
  double at =
      0;  ///< [s since the first stamp] time of a step: receipt of the next stamp less its excess delay
  double at_std_error = 0;  ///< [s]
  Eigen::VectorXd curve;    ///< [s] of a varying drift: see ClockCurve::delay
  double p_value = 1;       ///< permutation test of the minimum delays
  Gain gain;                ///< RMS of held-out minimum delays about the clock model

  struct Competitor {
    std::optional<Kind> kind;       ///< empty: no deviation
    double log10_bayes_factor = 0;  ///< log10 of the Bayes factor against it
  };
  /// Other deviations that could explain the minimum delays, the most likely first. The Bayes factors come
  /// from the BIC (normal errors of the minimum delays). Steps of clock and link compare by the device's own
  /// time, see log10_odds_of_jump(). A backlog has no cause in the catalogue and no competitors.
  std::vector<Competitor> competitors = {};

  bool is_step() const { return kind == Kind::clock_step || kind == Kind::latency_step; }
};

/// Tests the lower envelope of receipt less device time: the minimum delay in each of up to 64 windows. A
/// step is attributed to the device's clock if the time between two counts jumps with it, and otherwise to
/// the link.
///
/// @param tests  number of devices tested, for the correction of the p-value
/// @return  the most significant deviation with p < 0.002, if there is one
std::optional<ClockDeparture> clock_departure(std::span<const CountedStamp> stamps, std::size_t tests,
                                              std::uint64_t seed);

/// Removes a step of the clock or of the link from the stamps. A drift stays.
///
/// @param departure  its time counts from the first stamp
std::vector<CountedStamp> without_step(std::span<const CountedStamp> stamps, const ClockDeparture& departure);

/// Interval that contains the step of the device's clock; empty without a step.
std::optional<std::array<double, 2>> clock_step_interval(const std::optional<ClockDeparture>& departure);

}  // namespace crisp::diagnose
