// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/data/goodness_of_fit_tests.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "pipeline/statistics/multiple_testing.hpp"

namespace crisp::data {
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

FitStatistics corrected(std::vector<FitTest> tests) {
  FitStatistics all{.tests = std::move(tests)};
  const auto count = static_cast<double>(all.tests.size());
  for (FitTest& test : all.tests) {
    test.p_value = statistics::sidak_p_value(count, test.p_value);
    all.p_value = std::min(all.p_value, test.p_value);
  }
  return all;
}

void add_fit_statistics(const std::vector<GoodnessOfFit>& scopes, Findings& to) {
  if (scopes.empty()) return;
  const auto of_all = [&](double p_value) {
    return statistics::sidak_p_value(static_cast<double>(scopes.size()), p_value);
  };
  double before_p = 1;
  double after_p = 1;
  for (const GoodnessOfFit& one : scopes) {
    before_p = std::min(before_p, one.before.p_value);
    after_p = std::min(after_p, one.after.p_value);
    for (std::size_t k = 0; k < one.before.tests.size(); ++k) {
      const FitTest& before = one.before.tests[k];
      const FitTest& after = one.after.tests[k];
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

void add_left_over(const std::string& scope, const FitStatistics& left, std::size_t tests, Findings& to) {
  constexpr double kByChance = 0.002;
  for (const FitTest& test : left.tests) {
    const double p_value = statistics::sidak_p_value(static_cast<double>(tests), test.p_value);
    const bool is_known = std::ranges::any_of(to.unnamed, [&](const UnnamedFinding& known) {
      return known.scope == scope && known.covariate == test.covariate && known.quantity == test.quantity;
    });
    if (is_known || !(p_value < kByChance) || !(test.amplitude > 0)) continue;
    to.unnamed.push_back({.covariate = test.covariate,
                          .quantity = test.quantity,
                          .scope = scope,
                          .amplitude = test.amplitude,
                          .unit = test.unit,
                          .p_value = p_value,
                          .gain = {}});
  }
}

void add_left_over(const std::vector<GoodnessOfFit>& scopes, Findings& to) {
  for (const GoodnessOfFit& one : scopes) add_left_over(one.scope, one.after, scopes.size(), to);
}

std::string chance_in_words(double p_value) {
  return p_value > 0 ? fmt::format("p = {:.2g}", p_value) : "p < 1e-300";
}

std::string fit_statistics_text(const Findings& findings) {
  std::string words = fmt::format("measured and simulated residuals: {} before, {} after",
                                  chance_in_words(findings.before_p), chance_in_words(findings.after_p));
  const auto worst = worst_left(findings.departures);
  for (std::size_t k = 0; k < worst.size(); ++k)
    words += (k == 0 ? "; left: " : ", ") + left_in_words(worst[k]);
  return words;
}

}  // namespace crisp::data
