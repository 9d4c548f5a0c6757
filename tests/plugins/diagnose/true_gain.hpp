// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "plugins/diagnose/held_out.hpp"
#include "tests/plugins/diagnose/hidden.hpp"

namespace crisp::test {

/// The thickness of clouds [m] on turns that are held out, which a gain is judged by.
struct TrueThickness {
  double with_truth = 0;  ///< of the recording in which something hides, with the true parameters
  double clean = 0;       ///< of the same scanner, scene and motion where nothing hides
};

inline double thickness_of(const HeldOut& held_out, const SensorModel& model) {
  const auto score = held_out.score(model);
  return HeldOut::gains(score, score).at(0).after;
}

/// @param before  the model without what hides, as the diagnosis had it: it chooses the surfaces
inline TrueThickness true_thickness(const Recording& hidden, const Recording& clean,
                                    const SensorModel& before) {
  const auto halves = [](const Recording& of) { return halves_of(covered(of.sample(), -0.05, 0.05)); };
  const auto truth = [](const Recording& of) { return SensorModel(of.scanner.truth, built_in_terms()); };
  return {.with_truth = thickness_of(HeldOut(halves(hidden), before, {}), truth(hidden)),
          .clean = thickness_of(HeldOut(halves(clean), truth(clean), {}), truth(clean))};
}

}  // namespace crisp::test
