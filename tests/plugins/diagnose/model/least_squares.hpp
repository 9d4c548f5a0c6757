// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pipeline/quality/surfel_equations.hpp"

namespace crisp::test {

/// Normal equations of n residuals of unit noise, in blocks of ten. Block scores contain the noise only, as
/// for a model that has the true parameters.
class LeastSquares {
 public:
  LeastSquares(Eigen::Index parameters, Eigen::Index n)
      : equations_(static_cast<std::size_t>(parameters), {static_cast<std::size_t>(n / 10)}) {
    equations_.beams = static_cast<std::size_t>(n);
    equations_.degrees_of_freedom = equations_.weight = equations_.stiffness = static_cast<double>(n);
  }

  /// @param row    derivatives of the residual
  /// @param noise  noise part of the residual
  void add(const Eigen::VectorXd& row, double residual, double noise) {
    equations_.matrix += row * row.transpose();
    equations_.vector += row * residual;
    equations_.squares += row.cwiseAbs2();
    equations_.block_scores[0].col(added_++ / 10) += row * noise;
    equations_.influence += noise * noise;
  }

  const quality::NormalEquations& equations() const { return equations_; }

 private:
  quality::NormalEquations equations_;
  Eigen::Index added_ = 0;
};

}  // namespace crisp::test
