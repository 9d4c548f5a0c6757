// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/data/likeness.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "pipeline/data/least_chance.hpp"

namespace crisp {
namespace {

constexpr double kDeparts = 0.01;  // a p-value

/// The few that depart the most surely, whatever was found.
std::vector<ResidualDeparture> worst_left(std::vector<ResidualDeparture> departures) {
  constexpr std::size_t kFew = 3;
  std::erase_if(departures, [](const auto& one) { return !(one.p_value_after <= kDeparts); });
  std::ranges::stable_sort(departures, {}, &ResidualDeparture::p_value_after);
  departures.resize(std::min(departures.size(), kFew));
  return departures;
}

std::string left_in_words(const ResidualDeparture& left) {
  const std::string size = left.unit == "m" ? fmt::format("{:.2f} mm", 1e3 * left.amplitude_after)
                                            : fmt::format("{:.2g}", left.amplitude_after);
  return fmt::format("{} of {} over the {}, {}", left.quantity, left.scope, left.covariate, size);
}

}  // namespace

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

void add_left_over(const std::string& scope, const Likeness& left, std::size_t looks, Findings& to) {
  constexpr double kByChance = 0.002;
  for (const LikenessLook& look : left.looks) {
    const double p_value = least_of(static_cast<double>(looks), look.p_value);
    const bool is_known = std::ranges::any_of(to.unnamed, [&](const UnnamedFinding& known) {
      return known.scope == scope && known.covariate == look.covariate && known.quantity == look.quantity;
    });
    if (is_known || !(p_value < kByChance) || !(look.amplitude > 0)) continue;
    to.unnamed.push_back({.covariate = look.covariate,
                          .quantity = look.quantity,
                          .scope = scope,
                          .amplitude = look.amplitude,
                          .unit = look.unit,
                          .p_value = p_value,
                          .gain = {}});
  }
}

void add_left_over(const std::vector<ToldApart>& scopes, Findings& to) {
  for (const ToldApart& one : scopes) add_left_over(one.scope, one.after, scopes.size(), to);
}

std::string chance_in_words(double p_value) {
  return p_value > 0 ? fmt::format("p = {:.2g}", p_value) : "p < 1e-300";
}

std::string likeness_in_words(const Findings& findings) {
  std::string words = fmt::format("measured and simulated residuals: {} before, {} after",
                                  chance_in_words(findings.before_p), chance_in_words(findings.after_p));
  const auto worst = worst_left(findings.departures);
  for (std::size_t k = 0; k < worst.size(); ++k)
    words += (k == 0 ? "; left: " : ", ") + left_in_words(worst[k]);
  return words;
}

}  // namespace crisp
