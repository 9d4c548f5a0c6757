// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "plugins/diagnose/model/candidate_jacobian.hpp"
#include "plugins/diagnose/model/score_test.hpp"

namespace crisp::diagnose {

/// Translates the normal equations to a model whose candidates are all neutral.
quality::NormalEquations from_neutral(const CandidateJacobian& jacobian, quality::NormalEquations equations);

/// Normal equations of the remaining candidates after eliminating the base parameters and the candidates in
/// `taken` (Schur complement).
quality::NormalEquations eliminate_base(const std::vector<std::size_t>& taken,
                                        const CandidateJacobian& jacobian,
                                        const quality::NormalEquations& equations);

/// Score test of several candidates jointly. A form that was chosen from a grid counts as a parameter in the
/// BIC.
///
/// @param left  normal equations after eliminate_base()
ScoreTest joint_score_test(const std::vector<std::size_t>& some, const CandidateJacobian& jacobian,
                           const quality::NormalEquations& left);

/// Score test of each candidate given those in `taken`. Candidates in `taken` and their other forms have
/// none.
///
/// @param left  normal equations after eliminate_base()
std::vector<std::optional<ScoreTest>> score_tests(const quality::NormalEquations& left,
                                                  const std::vector<std::size_t>& taken,
                                                  const CandidateJacobian& jacobian);
std::vector<std::optional<ScoreTest>> score_tests_given(const std::vector<std::size_t>& taken,
                                                        const CandidateJacobian& jacobian,
                                                        const quality::NormalEquations& equations);

/// Normal equations of some candidates alone, after eliminating the base parameters and those in `taken`,
/// among which they are not.
quality::NormalEquations equations_given(const std::vector<std::size_t>& taken,
                                         const std::vector<std::size_t>& some,
                                         const CandidateJacobian& jacobian,
                                         const quality::NormalEquations& equations);

/// Joint score test of some candidates given those in `taken`, among which they are not.
ScoreTest joint_score_test_given(const std::vector<std::size_t>& taken, const std::vector<std::size_t>& some,
                                 const CandidateJacobian& jacobian,
                                 const quality::NormalEquations& equations);

/// Price of some candidates' forms in the BIC: one that was chosen from a grid counts as a parameter.
double price_of_forms(const std::vector<std::size_t>& some, const CandidateJacobian& jacobian,
                      std::size_t beams);

/// Identifiable combinations of a hardly observable candidate with the base parameters and those in `taken`:
/// see known_with(). Empty where those explain less than nearly all of the candidate's effect, because the
/// planes of the surfaces absorb it or the data are few.
std::string known_instead(std::size_t candidate, const std::vector<std::size_t>& taken,
                          const CandidateJacobian& jacobian, const quality::NormalEquations& equations);

}  // namespace crisp::diagnose
