// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>

#include <crisp/effect_catalogue.hpp>

#include "pipeline/model/terms/register_terms.hpp"

namespace crisp {

void register_built_in(TermRegistry& terms) {
  model::register_mount_terms(terms);
  model::register_mirror_terms(terms);
  model::register_encoder_terms(terms);
  model::register_plate_terms(terms);
  model::register_base_terms(terms);
  model::register_timing_terms(terms);
  model::register_range_terms(terms);
  model::register_range_in_time_terms(terms);
  model::register_empirical_terms(terms);
}

TermParameters neutral_parameters(const TermInfo& term) {
  TermParameters neutral{.term = term.name, .parameters = {}};
  for (const auto& p : term.parameters) {
    neutral.parameters.push_back({.name = p.name, .unit = p.unit, .value = p.neutral});
  }
  return neutral;
}

std::vector<EffectInfo> effect_catalogue(const TermRegistry& terms) {
  std::vector<EffectInfo> all = effects_beyond_the_chain();
  for (const auto& name : terms.names()) {
    const TermInfo& info = terms.get(name)->info();
    all.push_back({.name = info.name,
                   .summary = info.summary,
                   .scope = info.scope,
                   .parameters = info.parameters,
                   .details = info.details,
                   .resolvable_by = info.resolvable_by});
  }
  std::sort(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.name < b.name; });
  return all;
}

}  // namespace crisp
