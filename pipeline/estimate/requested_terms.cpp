// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/estimate/requested_terms.hpp"

#include <algorithm>

#include <crisp/effect_catalogue.hpp>
#include <crisp/error.hpp>

namespace crisp::estimate {
namespace {

void add(std::vector<TermParameters>& terms, const TermInfo& info) {
  const bool there = std::ranges::any_of(terms, [&](const auto& term) { return term.term == info.name; });
  if (!there) terms.push_back(neutral_parameters(info));
}

/// Whether a parameter, "laser2.mirror.cone.kappa", is of "mirror.cone" or "laser2.mirror.cone".
bool is_of(const std::string& parameter, const std::string& term) {
  const std::string with_owner = parameter.substr(0, parameter.rfind('.'));
  return with_owner == term || with_owner.substr(with_owner.find('.') + 1) == term;
}

/// A parameter's term, and its index among those of the term.
struct Declaration {
  const TermInfo* term = nullptr;  ///< null for λ, τ, α and η
  std::size_t index = 0;
};

Declaration declaration_of(const SensorModel& model, std::size_t parameter) {
  for (std::size_t laser = 0; laser < model.lasers(); ++laser) {
    const LaserChain& chain = model.chain(laser);
    const auto slot = std::ranges::find(chain.slots, parameter);
    if (slot == chain.slots.end()) continue;
    const auto at = static_cast<std::size_t>(slot - chain.slots.begin());
    for (const auto& phase : chain.phases) {
      for (const auto& [term, first] : phase) {
        if (at >= first && at < first + term->info().parameters.size())
          return {.term = &term->info(), .index = at - first};
      }
    }
  }
  return {};
}

}  // namespace

void add_requested_terms(Calibration& calibration, const std::vector<std::string>& requested,
                         const TermRegistry& terms) {
  for (const std::string& name : requested) {
    const std::string first = name.substr(0, name.find('.'));
    const bool owned = !terms.knows(name) && calibration.find(first);
    const auto term = terms.get(owned ? name.substr(first.size() + 1) : name);
    const TermInfo& info = term->info();
    if (info.scope == Scope::kPlate) {
      if (owned) throw Error(info.name + " is the plate's, not one laser's", "write " + info.name);
      add(calibration.plate_terms, info);
      continue;
    }
    for (auto& laser : calibration.lasers) {
      if (!owned || laser.name == first) add(laser.terms, info);
    }
  }
}

const EffectParameter* declared(const SensorModel& model, std::size_t parameter) {
  const Declaration declaration = declaration_of(model, parameter);
  return declaration.term != nullptr ? &declaration.term->parameters[declaration.index] : nullptr;
}

bool is_of_base_model(const SensorModel& model, std::size_t parameter) {
  const Declaration declaration = declaration_of(model, parameter);
  return declaration.term == nullptr || declaration.term->is_nuisance;
}

std::vector<std::size_t> parameters_of(const SensorModel& model, const std::vector<std::string>& requested,
                                       bool forms) {
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < model.names().size(); ++i) {
    const EffectParameter* parameter = declared(model, i);
    const auto named = [&](const std::string& term) { return is_of(model.names()[i], term); };
    if (!parameter || std::ranges::none_of(requested, named)) continue;
    const bool is_instant = parameter->tries.spacing == Tries::Spacing::kInstants;
    if (!parameter->shape || (forms && parameter->tries.count > 0 && !is_instant)) found.push_back(i);
  }
  return found;
}

}  // namespace crisp::estimate
