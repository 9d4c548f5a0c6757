// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <map>
#include <random>
#include <string>
#include <vector>

#include "grabbers/simulate/measurements.hpp"
#include "grabbers/simulate/scenes.hpp"
#include "pipeline/data/error.hpp"
#include "pipeline/estimate/wanted_terms.hpp"
#include "plugins/diagnose/diagnosis.hpp"
#include "tests/support/built_in_terms.hpp"

namespace crisp::test {

/// A term of a calibration, found by "laser2.mirror.cone" or "encoder.eccentricity".
inline TermParameters& term_of(Calibration& calibration, const std::string& name) {
  for (auto& term : calibration.plate_terms) {
    if (term.term == name) return term;
  }
  for (auto& laser : calibration.lasers) {
    for (auto& term : laser.terms) {
      if (laser.name + "." + term.term == name) return term;
    }
  }
  throw Error("there is no term " + name);
}

/// A recording in whose truth something hides.
struct Recording {
  ScannerSettings scanner;
  SimulatedMeasurements made;

  Sample sample() const { return {.beams = made.beams, .plate = &made.plate}; }
};

inline ScannerSettings scanner_of(std::uint64_t seed, double duration) {
  ScannerSettings scanner;
  scanner.seed = seed;
  scanner.duration = duration;
  return scanner;
}

inline Recording recorded(const ScannerSettings& scanner, const Scene& scene) {
  return {.scanner = scanner, .made = simulate_measurements(scanner, scene, built_in_terms())};
}

/// Hides terms with the values of their first parameters.
inline Recording hidden(std::uint64_t seed, double duration, const Scene& scene,
                        const std::map<std::string, std::vector<double>>& effects) {
  ScannerSettings scanner = scanner_of(seed, duration);
  for (const auto& [name, values] : effects) {
    add_wanted_terms(scanner.truth, {name}, built_in_terms());
    auto& parameters = term_of(scanner.truth, name).parameters;
    for (std::size_t k = 0; k < values.size(); ++k) parameters.at(k).value = values[k];
  }
  return recorded(scanner, scene);
}

inline Diagnosis diagnosed(const Recording& recording, const DiagnosisSettings& settings = {}) {
  return diagnose(SensorModel(nominal_calibration(recording.scanner.rig), built_in_terms()),
                  recording.sample(), built_in_terms(), settings);
}

inline std::vector<std::string> names_in(const Diagnosis& diagnosis) {
  std::vector<std::string> names;
  for (const auto& departure : diagnosis.departures) {
    if (departure.accepted) names.push_back(departure.candidate.name);
  }
  return names;
}

/// Errors of a term's estimated parameters in units of their standard errors.
inline std::vector<double> errors_of(const Diagnosis& diagnosis, Calibration truth, const std::string& name) {
  const Outcome& outcome = diagnosis.after.outcome;
  const auto& parameters = term_of(truth, name).parameters;
  std::vector<double> errors;
  for (std::size_t k = 0; k < outcome.free.size(); ++k) {
    const std::string& full = outcome.model.names()[outcome.free[k]];
    const std::string owned = full.starts_with("plate.") ? full.substr(6) : full;
    if (!owned.starts_with(name + ".")) continue;
    const auto which = std::ranges::find(parameters, owned.substr(name.size() + 1), &Parameter::name);
    const auto at = static_cast<Eigen::Index>(outcome.free[k]);
    const auto i = static_cast<Eigen::Index>(k);
    errors.push_back((outcome.model.values()[at] - which->value) / std::sqrt(outcome.covariance(i, i)));
  }
  return errors;
}

}  // namespace crisp::test
