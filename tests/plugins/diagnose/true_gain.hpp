// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "plugins/diagnose/model/cross_validation.hpp"
#include "tests/plugins/diagnose/hidden.hpp"

namespace crisp::test {

/// Thickness of clouds [m] on held-out turns, the reference for an estimated gain.
struct TrueThickness {
  double with_truth = 0;  ///< of the recording with the effect, under the true parameters
  double clean = 0;       ///< of the same scanner, scene and motion without the effect
};

inline double thickness_of(const diagnose::CrossValidator& held_out, const SensorModel& model) {
  const auto score = held_out.score(model);
  return diagnose::CrossValidator::gains(score, score).at(0).after;
}

/// @param before  the diagnosis's model without the effect: it selects surfaces, and so does the truth
inline TrueThickness true_thickness(const Recording& hidden, const Recording& clean,
                                    const SensorModel& before) {
  const auto halves = [](const Recording& of) {
    return diagnose::halves_of(estimate::covered(of.sample(), -0.05, 0.05));
  };
  const auto truth = [](const Recording& of) { return SensorModel(of.scanner.truth, built_in_terms()); };
  return {.with_truth = thickness_of(diagnose::CrossValidator(halves(hidden), {before, truth(hidden)}, {}),
                                     truth(hidden)),
          .clean = thickness_of(diagnose::CrossValidator(halves(clean), {truth(clean)}, {}), truth(clean))};
}

}  // namespace crisp::test
