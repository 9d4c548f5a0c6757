// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "pipeline/quality/surfel_equations.hpp"

namespace crisp::diagnose {

/// Score test of p parameters that could be added to a model (Rao 1948), without fitting them.
struct ScoreTest {
  Eigen::VectorXd value;       ///< p: one-step estimates
  Eigen::MatrixXd covariance;  ///< p × p: of the estimates, from the scatter of blocks of correlated errors
  double gain = 0;  ///< decrease of the weighted squares, in units of the residual variance: 2 ln(likelihood)
  double bic = 0;   ///< gain − p ln n: decrease of the BIC (Schwarz 1978)
  double wald = 0;  ///< valueᵀ covariance⁻¹ value: the smallest over several divisions into blocks
  double p_value = 1;  ///< of the Wald statistic under the null hypothesis (Hotelling's T² for few blocks);
                       ///< with too few blocks to measure the errors' excess, with the largest that occurs
  bool is_testable = false;  ///< whether a division has more blocks than parameters
  /// Design effect (Kish): variance of the value, along the value, relative to independent beam errors. It is
  /// valid where the model has the parameters; elsewhere blocks share the unmodeled effect. 1 where the
  /// excess is not significant.
  double design_effect() const;
  double visible = 0;  ///< [σ] RMS change of ranges that planes and the other parameters cannot absorb; σ is
                       ///< the range noise assumed by the surfels
  double whole = 0;  ///< [σ] total RMS change of ranges
  double ranges =
      0;  ///< [m] total RMS change of ranges, over all beams alike, also those of grazing incidence
  double ranges_error = 0;  ///< [m] its standard error; infinite if a direction is unobservable
  /// Share of the effect (in squares) that planes and the other parameters cannot absorb. Near 0 the
  /// parameters are unobservable in these data.
  double identifiability() const { return whole > 0 ? visible * visible / (whole * whole) : 0; }
};

/// p × q: directions of p parameters of which a thousandth or more is left (in squares), each such that a
/// unit of it gains 1. The others are unobservable.
///
/// @param matrix   p × p: of the normal equations
/// @param squares  p: see NormalEquations
Eigen::MatrixXd observable_directions(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& squares);

/// Tests parameters jointly. Unobservable directions are held at zero.
///
/// @param equations  with divisions into blocks, after eliminating the jointly estimated parameters
/// @param of         columns of the tested parameters
ScoreTest score_test(const quality::NormalEquations& equations, const std::vector<std::size_t>& of);

}  // namespace crisp::diagnose
