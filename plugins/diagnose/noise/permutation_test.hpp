// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>

#include <crisp/findings.hpp>

namespace crisp::diagnose {

/// Significance level of a cause in a time series, for p-values corrected for multiple testing.
constexpr double kSignificantInSeries = 0.002;

/// Permutation test of the best of several regressors in a linear model of a series.
struct PermutationTest {
  Eigen::Index column = 0;  ///< the regressor that fits best
  double p_value = 1;       ///< share of permutations of the residuals in which any regressor fits as well
  Eigen::VectorXd values;   ///< coefficients of the base's columns and of the best regressor
  Eigen::VectorXd errors;   ///< their standard errors
  Gain gain;                ///< see gain_in_series()
};

/// BIC of n residuals under a normal distribution of unknown variance, up to a constant.
///
/// @param squares  sum of the squared residuals
double bic_of_series(double squares, Eigen::Index n, double parameters);

/// Held-out gain of regressors over a base model: RMS residual of every other value for fits to the rest,
/// without and with them. The caller sets metric and unit.
Gain gain_in_series(const Eigen::MatrixXd& base, const Eigen::MatrixXd& columns,
                    const Eigen::VectorXd& values, std::uint64_t seed);

/// Tests each of several regressors in addition to a base, by least squares. The significance is that of 4999
/// permutations of the base's residuals, which assumes exchangeable values but no distribution.
///
/// @param base     n × m: regressors of the null hypothesis
/// @param columns  n × c: further regressors, tested one at a time
PermutationTest test_series(const Eigen::MatrixXd& base, const Eigen::MatrixXd& columns,
                            const Eigen::VectorXd& values, std::uint64_t seed);

}  // namespace crisp::diagnose
