// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/simulate/nominal_errors.hpp"

#include <fmt/format.h>

#include <algorithm>

#include <crisp/error.hpp>

#include "pipeline/statistics/random_stream.hpp"

namespace crisp::simulate {
namespace {

/// The term's parameters in this list, added with neutral values if need be.
TermParameters& find_or_add(std::vector<TermParameters>& terms, const TermInfo& info) {
  const auto found =
      std::find_if(terms.begin(), terms.end(), [&](const auto& term) { return term.term == info.name; });
  if (found != terms.end()) return *found;
  return terms.emplace_back(neutral_parameters(info));
}

void set(std::vector<TermParameters>& terms, const TermInfo& info, const Effect& effect) {
  auto& parameters = find_or_add(terms, info).parameters;
  for (const auto& [name, value] : effect.values) {
    const auto found = std::ranges::find(parameters, name, &Parameter::name);
    if (found == parameters.end()) {  // of a calibration's file: read_effects() knows the others
      throw Error("the calibration's " + info.name + " has no parameter " + name,
                  "compare it with `crisp effects`");
    }
    found->value = value;
  }
}

}  // namespace

Calibration draw_truth(const Calibration& nominal, const NominalErrors& nominal_errors, std::uint64_t seed) {
  for (const double departure :
       {nominal_errors.tau, nominal_errors.alpha, nominal_errors.lambda, nominal_errors.eta}) {
    if (!(departure >= 0)) {
      throw Error(fmt::format("the largest departure from nominal is {:g}, which is below 0", departure),
                  "give tau_off, alpha_off, lambda_off and eta_off of 0 or more");
    }
  }
  Calibration truth = nominal;
  for (std::size_t i = 0; i < truth.lasers.size(); ++i) {
    auto& laser = truth.lasers[i];
    statistics::RandomStream random(seed, laser.name + ".truth");
    laser.tau.value += random.uniform(-nominal_errors.tau, nominal_errors.tau);
    laser.alpha.value += random.uniform(-nominal_errors.alpha, nominal_errors.alpha);
    laser.eta.value += random.uniform(-nominal_errors.eta, nominal_errors.eta);
    if (i > 0) laser.lambda.value += random.uniform(-nominal_errors.lambda, nominal_errors.lambda);
  }
  return truth;
}

void add_terms(Calibration& truth, const std::vector<Effect>& effects, const TermRegistry& terms) {
  for (const auto& effect : effects) {
    if (!terms.knows(effect.name)) {
      std::string advice = "grabber.simulate can";
      if (effect.name == "scene.moving") {
        advice = "the scene determines what moves: `walk` of a thing in a scene_file, or scene: people";
      }
      if (effect.name == "encoder.slip")
        advice = "no stage simulates it; diagnose.encoder estimates it from captures";
      throw Error(effect.name + " is no term of the sensor model, so this stage cannot simulate it", advice,
                  effect.place);
    }
    const TermInfo& info = terms.get(effect.name)->info();
    if (info.scope == Scope::kPlate) set(truth.plate_terms, info, effect);
    for (std::size_t i = 0; info.scope == Scope::kLaser && i < truth.lasers.size(); ++i) {
      if (!effect.owner || *effect.owner == i) set(truth.lasers[i].terms, info, effect);
    }
  }
}

}  // namespace crisp::simulate
