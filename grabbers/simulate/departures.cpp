// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/simulate/departures.hpp"

#include <algorithm>
#include <variant>

#include "grabbers/simulate/random.hpp"
#include "pipeline/data/error.hpp"
#include "pipeline/files/quantity.hpp"

namespace crisp {
namespace {

/// "laser2.mirror.cone.kappa=0.3deg" taken apart.
struct Effect {
  std::string owner;  ///< empty: not given
  std::string term;
  std::string parameter;
  std::string value;
};

Effect split(const std::string& text, const Calibration& truth) {
  const auto equals = text.find('=');
  const auto last_dot = text.substr(0, equals).rfind('.');
  if (equals == std::string::npos || last_dot == std::string::npos) {
    throw Error("the effect '" + text + "' is not understood",
                "write it as laser2.mirror.cone.kappa=0.3deg or encoder.eccentricity.a=0.1deg");
  }
  Effect effect{.owner = {},
                .term = text.substr(0, last_dot),
                .parameter = text.substr(last_dot + 1, equals - last_dot - 1),
                .value = text.substr(equals + 1)};
  const std::string first = effect.term.substr(0, effect.term.find('.'));
  if (first == "plate" || truth.find(first)) {
    // A term of its own may begin with "plate." too: then the name as a whole decides, below.
    effect.owner = first;
    effect.term.erase(0, std::min(first.size() + 1, effect.term.size()));
  }
  return effect;
}

/// The term's parameters in this list, added with neutral values if need be.
TermParameters& find_or_add(std::vector<TermParameters>& terms, const TermInfo& info) {
  const auto found =
      std::find_if(terms.begin(), terms.end(), [&](const auto& term) { return term.term == info.name; });
  if (found != terms.end()) return *found;
  TermParameters added{.term = info.name, .parameters = {}};
  for (const auto& parameter : info.parameters) {
    added.parameters.push_back({.name = parameter.name, .unit = parameter.unit, .value = parameter.neutral});
  }
  return terms.emplace_back(std::move(added));
}

double parse_value(const std::string& effect, const std::string& text, const std::string& unit) {
  const auto parsed = parse_quantity(text, unit);
  if (const auto* complaint = std::get_if<Complaint>(&parsed)) {
    throw Error("the effect '" + effect + "': " + complaint->text);
  }
  return std::get<double>(parsed);
}

void set(std::vector<TermParameters>& terms, const TermInfo& info, const std::string& effect,
         const Effect& parts) {
  auto& parameters = find_or_add(terms, info).parameters;
  const auto found = std::find_if(parameters.begin(), parameters.end(),
                                  [&](const auto& known) { return known.name == parts.parameter; });
  if (found == parameters.end()) {
    std::string known;
    for (const auto& parameter : info.parameters) known += (known.empty() ? "" : ", ") + parameter.name;
    throw Error("the effect '" + effect + "': " + info.name + " has no parameter '" + parts.parameter + "'",
                "it has " + known);
  }
  found->value = parse_value(effect, parts.value, found->unit);
}

}  // namespace

Calibration draw_truth(const Calibration& nominal, const Departures& departures, std::uint64_t seed) {
  for (const double departure : {departures.tau, departures.alpha, departures.lambda, departures.eta}) {
    if (!(departure >= 0)) throw Error("the largest departure from nominal must not be negative");
  }
  Calibration truth = nominal;
  for (std::size_t i = 0; i < truth.lasers.size(); ++i) {
    auto& laser = truth.lasers[i];
    RandomStream random(seed, laser.name + ".truth");
    laser.tau.value += random.uniform(-departures.tau, departures.tau);
    laser.alpha.value += random.uniform(-departures.alpha, departures.alpha);
    laser.eta.value += random.uniform(-departures.eta, departures.eta);
    if (i > 0) laser.lambda.value += random.uniform(-departures.lambda, departures.lambda);
  }
  return truth;
}

void add_effect(Calibration& truth, const std::string& effect, const TermRegistry& terms) {
  Effect parts = split(effect, truth);
  if (parts.owner == "plate" && terms.knows("plate." + parts.term)) {
    parts.term = "plate." + parts.term;
    parts.owner.clear();
  }
  const auto term = terms.get(parts.term);
  const TermInfo& info = term->info();
  if (info.scope == Scope::kPlate) {
    if (!parts.owner.empty() && parts.owner != "plate") {
      throw Error("the effect '" + effect + "': " + info.name + " is the plate's, not one laser's");
    }
    return set(truth.plate_terms, info, effect, parts);
  }
  if (parts.owner == "plate") {
    throw Error("the effect '" + effect + "': " + info.name + " is each laser's, not the plate's");
  }
  for (auto& laser : truth.lasers) {
    if (parts.owner.empty() || parts.owner == laser.name) set(laser.terms, info, effect, parts);
  }
}

}  // namespace crisp
