// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <crisp/calibration.hpp>
#include <crisp/term.hpp>

namespace crisp::model {

/// Validates a calibration's parameters against the declarations of their term, by name, order and unit: with
/// any fault, the term would misinterpret the numbers.
std::vector<TermFault> faults_of(const TermParameters& given, const TermInfo& term);

/// Judges the same in a calibration that somebody wrote, and whether there is such a term, whether it is the
/// laser's or the plate's, and whether the values lie within its bounds.
/// @param terms  is referred to
JudgeTerm judge_by(const TermRegistry& terms);

}  // namespace crisp::model
