// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "pipeline/data/findings.hpp"

namespace crisp {

/// Below this p-value, corrected for the number of looks, what a series shows is given a name.
constexpr double kSignificantInSeries = 0.002;

/// What a short series of values shows beside what is expected of it.
struct SeriesLook {
  Eigen::Index column = 0;  ///< the one that does best
  double p_value = 1;       ///< how often any column does as much where what is left is shuffled
  Eigen::VectorXd values;   ///< of the base's columns, then of that one
  Eigen::VectorXd errors;   ///< of them: standard errors
  Gain gain;                ///< see gain_in_series()
};

/// BIC of a normal law of unknown width of what is left of n values, but for what is the same whatever is
/// left.
///
/// @param squares  of what is left, summed
double bic_of_series(double squares, Eigen::Index n, double parameters);

/// What columns bring beside a base for values that they were not fitted to: the RMS of every other value
/// about a fit to the rest, without them and with them. Metric and unit are left open.
Gain gain_in_series(const Eigen::MatrixXd& base, const Eigen::MatrixXd& columns,
                    const Eigen::VectorXd& values, std::uint64_t seed);

/// Tries each of some columns beside a base, by least squares. Significance is by 4999 permutations of what
/// the base leaves, so that no law of the values is assumed but that they are exchangeable.
///
/// @param base     n × m: what is expected
/// @param columns  n × c: what is tried, one at a time
SeriesLook look_at_series(const Eigen::MatrixXd& base, const Eigen::MatrixXd& columns,
                          const Eigen::VectorXd& values, std::uint64_t seed);

}  // namespace crisp
