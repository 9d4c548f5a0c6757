// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <string>
#include <vector>

#include <crisp/error.hpp>

#include "grabbers/simulate/measurements.hpp"
#include "grabbers/simulate/scenes.hpp"
#include "pipeline/estimate/requested_terms.hpp"
#include "plugins/diagnose/model/diagnosis.hpp"
#include "tests/support/built_in_terms.hpp"

namespace crisp::test {

/// Finds a term of a calibration by its name: "laser2.mirror.cone" or "encoder.eccentricity".
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

/// A simulated recording with its truth.
struct Recording {
  simulate::ScannerSettings scanner;
  simulate::SimulatedMeasurements made;

  estimate::Sample sample() const { return {.beams = made.beams, .plate = &made.plate}; }
};

inline simulate::ScannerSettings scanner_of(std::uint64_t seed, double duration) {
  simulate::ScannerSettings scanner;
  scanner.seed = seed;
  scanner.duration = duration;
  return scanner;
}

inline Recording recorded(const simulate::ScannerSettings& scanner, const simulate::Scene& scene) {
  return {.scanner = scanner, .made = simulate::simulate_measurements(scanner, scene, built_in_terms())};
}

/// Simulates terms with the given values of their first parameters.
inline Recording hidden(std::uint64_t seed, double duration, const simulate::Scene& scene,
                        const std::map<std::string, std::vector<double>>& effects) {
  simulate::ScannerSettings scanner = scanner_of(seed, duration);
  for (const auto& [name, values] : effects) {
    estimate::add_requested_terms(scanner.truth, {name}, built_in_terms());
    auto& parameters = term_of(scanner.truth, name).parameters;
    for (std::size_t k = 0; k < values.size(); ++k) parameters.at(k).value = values[k];
  }
  return recorded(scanner, scene);
}

inline diagnose::Diagnosis diagnosed(const Recording& recording,
                                     const diagnose::DiagnosisSettings& settings = {}) {
  return diagnose::diagnose(SensorModel(nominal_calibration(recording.scanner.rig), built_in_terms()),
                            recording.sample(), built_in_terms(), settings);
}

inline std::vector<std::string> names_in(const diagnose::Diagnosis& diagnosis) {
  std::vector<std::string> names;
  for (const auto& hypothesis : diagnosis.hypotheses) {
    if (hypothesis.accepted) names.push_back(hypothesis.candidate.name);
  }
  return names;
}

/// Whether a cause could be that of another name as well.
inline bool stands_for(const diagnose::Hypothesis& hypothesis, const std::string& name) {
  return std::ranges::any_of(hypothesis.competitors, [&](const auto& competitor) {
    return competitor.name == name && competitor.behind < diagnose::SelectionSettings{}.odds;
  });
}

/// Estimate of one parameter compared with its truth.
struct Reported {
  std::string name;
  double truth = 0;
  double estimate = 0;
  double std_error = 0;
  double error() const { return (estimate - truth) / std_error; }  ///< in standard errors
};

/// Estimates of a term's parameters.
inline std::vector<Reported> estimates_of(const diagnose::Diagnosis& diagnosis, Calibration truth,
                                          const std::string& term) {
  const estimate::Outcome& outcome = diagnosis.after.outcome;
  const auto& parameters = term_of(truth, term).parameters;
  std::vector<Reported> all;
  for (std::size_t k = 0; k < outcome.free.size(); ++k) {
    const std::string& full = outcome.model.names()[outcome.free[k]];
    const std::string owned = full.starts_with("plate.") ? full.substr(6) : full;
    if (!owned.starts_with(term + ".")) continue;
    const auto which = std::ranges::find(parameters, owned.substr(term.size() + 1), &Parameter::name);
    const auto at = static_cast<Eigen::Index>(outcome.free[k]);
    const auto i = static_cast<Eigen::Index>(k);
    all.push_back({.name = which->name,
                   .truth = which->value,
                   .estimate = outcome.model.values()[at],
                   .std_error = std::sqrt(outcome.covariance(i, i))});
  }
  return all;
}

}  // namespace crisp::test
