// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/diagnose/noise.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <cmath>
#include <map>
#include <numbers>

#include "plugins/diagnose/likelihood_gain.hpp"
#include "plugins/diagnose/noise_doubts.hpp"
#include "plugins/diagnose/noise_errors.hpp"
#include "plugins/diagnose/noise_ways.hpp"

namespace crisp {
namespace {

constexpr double kBic = 10;  // least by which it must rise

double log_likelihood(const NoiseLaw& law, const RangeErrors& errors) {
  double sum = 0;
  for (std::size_t i = 0; i < errors.size(); ++i) {
    sum += law.log_density(double{errors.value[i]}, errors.echo(i), errors.beam[i]);
  }
  return sum;
}

std::map<std::uint16_t, double> beams_in(const RangeErrors& errors) {
  std::map<std::uint16_t, double> counts;
  for (const std::uint16_t beam : errors.beam) counts[beam] += 1;
  return counts;
}

/// How many parameters a law has that all ranges tell, and how many that those of each beam do.
struct Freedoms {
  double of_all = 0, of_each = 0;
};

Freedoms freedoms_of(const NoiseLaw& law) {
  const auto parts = static_cast<double>(std::ranges::count(law.parts, true));
  return {.of_all = parts + (law.has_tail ? 2 : 0) + (law.has_peaks() ? 1 : 0),
          .of_each = (law.has_peaks() ? 1.0 : 0.0) + (law.has_relative() ? 1 : 0)};
}

/// Twice the log-likelihood, less what a law's parameters cost: ln of the number of ranges that tell each.
double bic_of(const NoiseLaw& law, const RangeErrors& errors) {
  const Freedoms freedoms = freedoms_of(law);
  double price = freedoms.of_all * std::log(static_cast<double>(errors.size()));
  for (const auto& [beam, count] : beams_in(errors)) price += freedoms.of_each * std::log(count);
  return 2 * log_likelihood(law, errors) - price;
}

/// Mean log-likelihood of every other block under laws that were fitted to the rest.
Gain gain_of(const NoiseLaw& before, const NoiseLaw& after, const RangeErrors& errors, std::uint64_t seed) {
  const auto fitted_half = select(errors, [&](std::size_t i) { return errors.block[i] % 2 == 0; });
  const NoiseLaw first = fitted(before, fitted_half);
  const NoiseLaw second = fitted(after, fitted_half);
  const auto rest = select(errors, [&](std::size_t i) { return errors.block[i] % 2 == 1; });
  std::vector<double> without;
  std::vector<double> with;
  for (std::size_t i = 0; i < rest.size(); ++i) {
    without.push_back(first.log_density(double{rest.value[i]}, rest.echo(i), rest.beam[i]));
    with.push_back(second.log_density(double{rest.value[i]}, rest.echo(i), rest.beam[i]));
  }
  return likelihood_gain(without, with, rest.block, seed);
}

/// A way of not being normal that has been tried beside what the law already has.
struct Tried {
  std::size_t way = 0;
  NoiseLaw law;
  double rise = 0;                       // of BIC
  double lead = 0;                       // over the next best
  std::vector<std::string> as_probable;  // causes within 100 : 1
  std::vector<OtherCause> others;        // all causes, the likeliest first
};

Tried best_of(const std::string& scope, const std::vector<NoiseWay>& ways, const NoiseLaw& law,
              const RangeErrors& errors) {
  constexpr double kOdds = 9.2;  // of BIC: 100 : 1
  const double before = bic_of(law, errors);
  std::vector<double> rises;
  Tried best;
  for (std::size_t w = 0; w < ways.size(); ++w) {
    NoiseLaw one = law;
    ways[w].add(one);
    one = fitted(one, errors);
    rises.push_back(bic_of(one, errors) - before);
    if (rises.back() > best.rise) best = {.way = w, .law = std::move(one), .rise = rises.back()};
  }
  best.lead = best.rise;
  for (std::size_t w = 0; w < ways.size(); ++w) {
    if (w == best.way) continue;
    best.lead = std::min(best.lead, best.rise - rises[w]);
    if (ways[w].cause.empty()) continue;
    const double behind = best.rise - rises[w];
    if (rises[w] > 0 && behind < kOdds) best.as_probable.push_back(ways[w].cause);
    best.others.push_back(
        {.cause = ways[w].cause, .scope = scope, .log10_odds = behind / 2 / std::numbers::ln10});
  }
  std::ranges::stable_sort(best.others, {}, &OtherCause::log10_odds);
  return best;
}

double p_value_of(const NoiseLaw& before, const NoiseLaw& after, const RangeErrors& errors) {
  const auto beams = static_cast<double>(beams_in(errors).size());
  const auto count = [&](const NoiseLaw& law) {
    const Freedoms freedoms = freedoms_of(law);
    return freedoms.of_all + beams * freedoms.of_each;
  };
  const double fall = 2 * (log_likelihood(after, errors) - log_likelihood(before, errors));
  return fall > 0 ? cdf(complement(boost::math::chi_squared(count(after) - count(before)), fall)) : 1;
}

/// A way that was found, with all that is to be said of it but its parameters.
struct Found {
  NoiseWay way;
  NoiseLaw law;  // where it was found
  Finding finding;

  bool is_cause() const { return !way.cause.empty(); }
};

Found found_of(const std::string& scope, const NoiseWay& way, const Tried& tried, const NoiseLaw& before,
               const RangeErrors& errors, std::uint64_t seed) {
  Finding finding{.cause = way.cause,
                  .scope = scope,
                  .parameters = {},
                  .log10_odds = tried.lead / 2 / std::numbers::ln10,
                  .p_value = p_value_of(before, tried.law, errors),
                  .confounded_with = {},
                  .alternatives = tried.others,
                  .gain = {gain_of(before, tried.law, errors, seed)}};
  for (const std::string& cause : tried.as_probable) {
    finding.confounded_with.push_back(fmt::format("{}.{}", scope, cause));
  }
  finding.accepted = finding.gain[0].surely_rises();
  return {.way = way, .law = tried.law, .finding = std::move(finding)};
}

/// Takes out of the law what the one that joined last has made needless.
void leave_needless(std::vector<Found>& found, NoiseLaw& law, const RangeErrors& errors, double least_rise) {
  for (std::size_t k = 0; k + 1 < found.size();) {
    NoiseLaw without = law;
    found[k].way.take_away(without);
    without = fitted(without, errors);
    if (!found[k].finding.accepted || bic_of(law, errors) - bic_of(without, errors) >= least_rise) {
      ++k;
      continue;
    }
    law = std::move(without);
    found.erase(found.begin() + static_cast<std::ptrdiff_t>(k));
  }
}

UnnamedFinding unnamed_of(const Finding& finding, const NoiseLaw& law, const RangeErrors& errors) {
  double squares = 0;
  for (std::size_t i = 0; i < errors.size(); ++i) {
    squares += std::pow(deviation(law.size, errors.echo(i)) * (law.relative[errors.beam[i]] - 1), 2);
  }
  return {.covariate = "beam",
          .quantity = "noise",
          .scope = finding.scope,
          .amplitude = std::sqrt(squares / static_cast<double>(errors.size())),
          .unit = "m",
          .p_value = finding.p_value,
          .gain = finding.gain,
          .accepted = finding.accepted};
}

/// @param named  the law where the last cause joined: what has no name is not simulated, so that the causes
///               describe the ranges as well as they can without what was found behind them
void report(std::vector<Found> found, const NoiseLaw& named, const RangeErrors& errors, NoiseDiagnosis& to) {
  const bool is_asked =
      std::ranges::any_of(found, [](const Found& one) { return one.is_cause() && one.finding.accepted; });
  const LawInParts fits = is_asked ? in_parts(named, errors) : LawInParts{};
  for (Found& one : found) {
    if (!one.is_cause()) {
      to.unnamed.push_back(unnamed_of(one.finding, one.law, errors));
      continue;
    }
    one.finding.parameters = one.finding.accepted ? parameters_of(one.way, fits)
                                                  : parameters_of(one.way, in_parts(one.law, errors));
    if (one.finding.accepted) one.finding.refused = refusal_of(one.finding, one.way, named, errors);
    if (!one.finding.refused.empty()) {
      one.finding.accepted = false;
      one.way.take_away(to.law);
      to.law = fitted(to.law, errors);
    }
    to.findings.push_back(std::move(one.finding));
  }
}

}  // namespace

NoiseDiagnosis diagnose_noise(const std::string& scope, const RangeErrors& all, std::uint64_t seed,
                              double least_gain) {
  constexpr std::size_t kMost = 120'000;  // tell all there is to tell
  const RangeErrors errors = thinned(all, kMost);
  NoiseDiagnosis result{.plain = fitted({}, errors), .law = {}, .findings = {}, .unnamed = {}};
  result.law = result.plain;
  NoiseLaw named = result.plain;
  const double least_rise = std::max(kBic, 2 * least_gain * static_cast<double>(errors.size()));
  auto left = noise_ways(all, result.plain.sigma());  // the law is asked of all, and knows all beams
  std::vector<Found> found;
  while (!left.empty()) {
    const Tried best = best_of(scope, left, result.law, errors);
    if (best.rise < kBic) break;
    Found one = found_of(scope, left[best.way], best, result.law, errors, seed);
    if (one.finding.gain[0].after - one.finding.gain[0].before < least_gain) break;
    left.erase(left.begin() + static_cast<std::ptrdiff_t>(best.way));
    found.push_back(std::move(one));
    if (!found.back().finding.accepted) continue;
    result.law = best.law;
    leave_needless(found, result.law, errors, least_rise);
    if (found.back().is_cause()) named = result.law;
  }
  report(std::move(found), named, errors, result);
  return result;
}

}  // namespace crisp
