// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <set>
#include <string>
#include <vector>

#include "plugins/diagnose/model/competing_causes.hpp"

namespace crisp::diagnose {

/// Thresholds of the stepwise selection.
struct SelectionSettings {
  double bic = 10;        ///< minimum decrease of the BIC
  double p_value = 1e-3;  ///< significance level, before correction for multiple testing
  double untested =
      50;  ///< gain (2 nat) from which on what the model lacks is selected without a test by blocks
  double visible = 0.015;  ///< [σ] minimum RMS change of ranges: edges and bumps of surfaces make less
  double odds = 9.2;       ///< difference in BIC below which two causes are not resolvable (Bayes factor 100)
  std::size_t most = 12;   ///< maximum number of selected candidates
};

/// Stepwise selection of candidates by BIC on the linearized problem: forward selection, each step followed
/// by backward elimination (cf. orthogonal matching pursuit). An effect that all lasers share hardly shows
/// while one of them alone is corrected, so the same cause is also tested for all lasers jointly. The
/// block-based significance test applies only to candidates that the model has: an unmodeled effect itself
/// makes the blocks scatter.
///
/// @param equations  normal equations at the current model, in the Jacobian's columns, with blocks
/// @param rejected   names of candidates that are excluded
/// @param tests      number of different candidates tested, where the Jacobian has only some of them
/// @return  in the order of selection
std::vector<SelectedCandidate> choose(const CandidateJacobian& jacobian,
                                      const quality::NormalEquations& equations,
                                      const SelectionSettings& settings,
                                      const std::set<std::string>& rejected = {}, std::size_t tests = 0);

}  // namespace crisp::diagnose
