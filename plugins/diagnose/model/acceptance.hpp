// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>

#include "plugins/diagnose/model/diagnosis.hpp"
#include "plugins/diagnose/model/generalization.hpp"

namespace crisp::diagnose {

/// The fits that acceptance needs.
struct AcceptanceFits {
  HeldOutScore held_out;
  std::function<estimate::Refinement(const Calibration& start)> refit;        ///< to all turns
  std::function<ProfileComparison(const estimate::Refinement& fit)> compare;  ///< with the simulated scanner
};

/// Decides which hypotheses the extended model keeps. It refits the model to those that are accepted, and
/// records each test in its hypothesis. The rules, in their order:
///
/// 1. Effects of several lasers must exceed what surfaces that are no planes resemble, unless the residuals
///    agree with the simulation with them alone.
/// 2. A hypothesis must improve the fit on held-out turns (cross-validation).
/// 3. It must be significant in the joint fit (Wald test; score test if parameters are held).
/// 4. A cause must explain more than the systematic residual that the extended model leaves.
///
/// @param plain  held-out score of the model without hypotheses
void accept_or_reject(Diagnosis& diagnosis, const CrossValidator::Score& plain, const AcceptanceFits& fits,
                      const TermRegistry& terms, const DiagnosisSettings& settings);

}  // namespace crisp::diagnose
