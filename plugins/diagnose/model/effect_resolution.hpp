// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "plugins/diagnose/model/candidate_jacobian.hpp"
#include "plugins/diagnose/model/stepwise_selection.hpp"

namespace crisp::diagnose {

/// How large an effect must be for a recording to show it, and to resolve its cause from all others. Sizes
/// are RMS changes of the ranges of the beams that it acts on.
struct EffectResolution {
  std::string cause;  ///< "laser2.range.incidence"
  /// [m] From this size on it is significant, whatever its phase; infinite if the other parameters absorb it.
  double detectable = std::numeric_limits<double>::infinity();
  /// [m] From this size on no other cause could stand in its place; infinite if one could at any size.
  double resolvable = std::numeric_limits<double>::infinity();
  std::vector<std::string> confounded_with = {};  ///< causes that could below that, the last to part first
  /// Of a cause with one parameter and one form: its name, unit, and change [SI] with 1 m of the size; else
  /// empty.
  std::string parameter = {};
  std::string unit = {};
  double per_metre = 0;
};

/// The causes among the candidates, each in one form, the middle one of its grid: what resolution is about.
std::vector<Candidate> typical_causes(std::vector<Candidate> all);

/// Resolution of each cause, in its own formula, by beams with independent noise: what stepwise selection
/// would decide on average (SelectionSettings: BIC, gain without a test by blocks, visible effect, odds).
/// Real beams share errors, so that real effects must be larger. Directions of a cause's parameters that
/// others absorb altogether are left out.
///
/// @param equations  at the true model, in the Jacobian's columns; only its matrix and what scales it count
/// @param is_wanted  of which candidates
std::vector<EffectResolution> effect_resolutions(
    const CandidateJacobian& jacobian, const quality::NormalEquations& equations,
    const SelectionSettings& settings,
    const std::function<bool(const Candidate&)>& is_wanted = [](const Candidate&) { return true; });

/// The equations that so many beams like the present ones would give, without noise.
quality::NormalEquations planned_with(quality::NormalEquations equations, double beams);

}  // namespace crisp::diagnose
