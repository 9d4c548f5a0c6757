// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>

#include <crisp/effect_catalogue.hpp>

#include "tests/pipeline/model/support.hpp"
#include "tests/support/built_in_terms.hpp"

namespace crisp {

/// The term's parameters: those that are given, and the others neutral.
inline TermParameters with_values(const TermInfo& info, const std::map<std::string, double>& given = {}) {
  TermParameters term = neutral_parameters(info);
  for (auto& parameter : term.parameters) {
    if (const auto found = given.find(parameter.name); found != given.end()) parameter.value = found->second;
  }
  return term;
}

/// Puts a term into the first laser or the plate, as it is of.
inline void add_term(Calibration& calibration, const std::string& name,
                     const std::map<std::string, double>& given = {}) {
  const auto& info = built_in_terms().get(name)->info();
  auto& owner = info.scope == Scope::kPlate ? calibration.plate_terms : calibration.lasers[0].terms;
  owner.push_back(with_values(info, given));
}

/// Where one beam ends, with one term in the chain.
inline Eigen::Vector3d point_with(const std::string& term, const std::map<std::string, double>& given,
                                  Calibration calibration, const Measurements& beam,
                                  const PlateTrajectory& plate) {
  add_term(calibration, term, given);
  const auto placed = SensorModel(calibration, built_in_terms()).place(beam, plate);
  return placed.points.col(0);
}

}  // namespace crisp
