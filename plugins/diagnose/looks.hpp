// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "pipeline/quality/surfel_equations.hpp"

namespace crisp {

/// What data say of p parameters that could be added to a model, without adding them: the score test.
struct Look {
  Eigen::VectorXd value;       ///< p: what they would be
  Eigen::MatrixXd covariance;  ///< p × p: of these, by the scatter of blocks that may share an error
  double gain = 0;  ///< by how much the squares fall, in units of the residuals' variance: 2 ln(likelihood)
  double bic = 0;   ///< gain − p ln n: what is left of that after the price of parameters (Schwarz)
  double wald = 0;  ///< valueᵀ covariance⁻¹ value: of several divisions into blocks, by the one by which it
                    ///< is least
  double p_value = 1;  ///< of that, or greater, where nothing is there (Hotelling's law: blocks are few)
  /// By how much errors that beams share make the value's variance larger than independent ones would, along
  /// the value. It holds where the model has the value: elsewhere blocks share what is missing. 1 where it
  /// may be chance.
  double sharing() const;
  double visible =
      0;  ///< [σ] RMS over the beams by which ranges change, after planes and the other parameters
          ///< have taken what they can; σ is the noise of ranges that the surfels were told
  double whole = 0;  ///< [σ] RMS by which ranges change at all
  double ranges =
      0;  ///< [m] the same of all beams that change alike, also of those that graze and count little
  double ranges_error = 0;  ///< [m] standard error of that; infinite if a direction is hidden
  /// Share of the whole (in squares) that planes and the other parameters cannot take. Near 0 the parameters
  /// are unobservable in these data.
  double identifiability() const { return whole > 0 ? visible * visible / (whole * whole) : 0; }
};

/// @param equations  with divisions into blocks, after whatever is to be estimated as well was projected out
/// @param of         the parameters to look at
/// Directions that nothing is left of are held at zero.
Look look_at(const NormalEquations& equations, const std::vector<std::size_t>& of);

}  // namespace crisp
