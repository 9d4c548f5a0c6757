// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/data/likeness.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "pipeline/data/least_chance.hpp"

namespace crisp {

Likeness corrected(std::vector<LikenessLook> looks) {
  Likeness all{.looks = std::move(looks)};
  const auto count = static_cast<double>(all.looks.size());
  for (LikenessLook& look : all.looks) {
    look.p_value = least_of(count, look.p_value);
    all.p_value = std::min(all.p_value, look.p_value);
  }
  return all;
}

void add_likeness(const std::vector<ToldApart>& scopes, Findings& to) {
  constexpr double kDeparts = 0.01;
  if (scopes.empty()) return;
  const auto of_all = [&](double p_value) { return least_of(static_cast<double>(scopes.size()), p_value); };
  double before_p = 1;
  double after_p = 1;
  for (const ToldApart& one : scopes) {
    before_p = std::min(before_p, one.before.p_value);
    after_p = std::min(after_p, one.after.p_value);
    for (std::size_t k = 0; k < one.before.looks.size(); ++k) {
      const LikenessLook& before = one.before.looks[k];
      const LikenessLook& after = one.after.looks[k];
      if (of_all(std::min(before.p_value, after.p_value)) > kDeparts) continue;
      to.departures.push_back({.covariate = before.covariate,
                               .quantity = before.quantity,
                               .scope = one.scope,
                               .amplitude = before.amplitude,
                               .unit = before.unit,
                               .p_value = of_all(before.p_value),
                               .amplitude_after = after.amplitude,
                               .p_value_after = of_all(after.p_value)});
    }
  }
  to.append({.before_p = of_all(before_p), .after_p = of_all(after_p)});
}

std::string chance_in_words(double p_value) {
  return p_value > 0 ? fmt::format("p = {:.2g}", p_value) : "p < 1e-300";
}

std::string likeness_in_words(const Findings& findings) {
  return fmt::format("measured and simulated residuals: {} before, {} after",
                     chance_in_words(findings.before_p), chance_in_words(findings.after_p));
}

}  // namespace crisp
