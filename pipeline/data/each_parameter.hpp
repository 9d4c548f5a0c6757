// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include <crisp/calibration.hpp>

namespace crisp::data {

/// Calls `act` with each parameter's full name ("laser1.tau", "plate.encoder.eccentricity.a") and itself, in
/// the order of the file.
template <class Calibrated, class Act>
void for_each_parameter(Calibrated& calibration, const Act& act) {
  const auto with_terms = [&](auto& terms, const std::string& owner) {
    for (auto& term : terms) {
      for (auto& parameter : term.parameters) act(owner + "." + term.term + "." + parameter.name, parameter);
    }
  };
  for (auto& laser : calibration.lasers) {
    for (auto* p : {&laser.lambda, &laser.tau, &laser.alpha, &laser.eta}) act(laser.name + "." + p->name, *p);
    with_terms(laser.terms, laser.name);
  }
  with_terms(calibration.plate_terms, "plate");
}

}  // namespace crisp::data
