// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/diagnose/noise.hpp"

#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>

#include "plugins/diagnose/likelihood_gain.hpp"

namespace crisp {
namespace {

double log_likelihood(const NoiseLaw& law, const RangeErrors& errors) {
  double sum = 0;
  for (std::size_t i = 0; i < errors.size(); ++i) {
    sum += law.log_density(double{errors.value[i]}, double{errors.range[i]}, errors.beam[i]);
  }
  return sum;
}

std::map<std::uint16_t, double> beams_in(const RangeErrors& errors) {
  std::map<std::uint16_t, double> counts;
  for (const std::uint16_t beam : errors.beam) counts[beam] += 1;
  return counts;
}

/// What a law's parameters cost, as BIC has it: ln of the number of ranges that each is told by.
double price(const NoiseLaw& law, const RangeErrors& errors) {
  const double of_all = std::log(static_cast<double>(errors.size()));
  double sum = of_all * (1 + (law.has_slope ? 1 : 0) + (law.has_tail ? 2 : 0) + (law.has_peaks() ? 1 : 0));
  const double of_each = (law.has_peaks() ? 1 : 0) + (law.has_spread() ? 1 : 0);
  for (const auto& [beam, count] : beams_in(errors)) sum += of_each * std::log(count);
  return sum;
}

RangeErrors some_of(const RangeErrors& errors, const std::function<bool(std::uint32_t block)>& is_wanted) {
  RangeErrors some;
  for (std::size_t i = 0; i < errors.size(); ++i) {
    if (!is_wanted(errors.block[i])) continue;
    some.value.push_back(errors.value[i]);
    some.range.push_back(errors.range[i]);
    some.beam.push_back(errors.beam[i]);
    some.block.push_back(errors.block[i]);
  }
  return some;
}

/// Some blocks of all, strewn: as many ranges as tell all there is to tell.
RangeErrors thinned(const RangeErrors& errors) {
  constexpr std::size_t kMost = 120'000;
  constexpr std::uint32_t kStrewn = 2'654'435'761;  // Knuth's multiplicative hash
  const auto nth = static_cast<std::uint32_t>((errors.size() + kMost - 1) / kMost);
  if (nth <= 1) return errors;
  return some_of(errors, [nth](std::uint32_t block) { return (block * kStrewn >> 16) % nth == 0; });
}

/// One way of not being normal.
struct Way {
  const char* cause;
  std::function<void(NoiseLaw&)> add;
  std::function<std::vector<Parameter>(const NoiseLaw&)> parameters;
};

double quantile_of(std::vector<double> values, double share) {
  std::ranges::sort(values);
  return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
}

std::vector<Way> ways(const RangeErrors& errors, double sigma) {
  const std::size_t beams = beams_of(errors);
  return {{"",  // no cause: each beam has a spread of its own, of what it meets or of itself
           [beams](NoiseLaw& law) { law.spread.assign(beams, 1); },
           [](const NoiseLaw&) { return std::vector<Parameter>{}; }},
          {"noise.range_dependent", [](NoiseLaw& law) { law.has_slope = true; },
           [](const NoiseLaw& law) {
             return std::vector<Parameter>{{.name = "slope", .unit = "1", .value = law.slope}};
           }},
          {"noise.heavy_tail",
           [](NoiseLaw& law) {
             law.has_tail = true;
             law.tail_share = 0.02;
           },
           [](const NoiseLaw& law) {
             return std::vector<Parameter>{{.name = "share", .unit = "1", .value = law.tail_share},
                                           {.name = "scale", .unit = "1", .value = law.tail_scale}};
           }},
          {"noise.two_peaks",
           [beams, sigma](NoiseLaw& law) {
             law.weight.assign(beams, 0.5);
             law.separation = 1.6 * sigma;
             law.sigma = 0.6 * sigma;
           },
           [](const NoiseLaw& law) {
             return std::vector<Parameter>{
                 {.name = "separation", .unit = "m", .value = law.separation},
                 {.name = "least", .unit = "1", .value = quantile_of(law.weight, 0.05)},
                 {.name = "most", .unit = "1", .value = quantile_of(law.weight, 0.95)}};
           }}};
}

/// Standard errors by leaving out one of eight parts of the recording after another (jackknife).
void add_errors(const NoiseLaw& law, const RangeErrors& errors, const Way& way,
                std::vector<Parameter>& found) {
  constexpr std::uint32_t kParts = 8;
  std::vector<std::vector<Parameter>> without;
  for (std::uint32_t part = 0; part < kParts; ++part) {
    const auto rest = some_of(errors, [part](std::uint32_t block) { return block % kParts != part; });
    without.push_back(way.parameters(fitted(law, rest)));
  }
  for (std::size_t k = 0; k < found.size(); ++k) {
    double sum = 0;
    double squares = 0;
    for (const auto& one : without) {
      sum += one[k].value;
      squares += one[k].value * one[k].value;
    }
    const double spread = squares / kParts - std::pow(sum / kParts, 2);
    found[k].std_error = std::sqrt(std::max(0.0, spread) * (kParts - 1));
    found[k].free = true;
  }
}

/// Mean log-likelihood of every other block under laws that were fitted to the rest.
Gain gain_of(const NoiseLaw& before, const NoiseLaw& after, const RangeErrors& errors, std::uint64_t seed) {
  const auto fitted_half = some_of(errors, [](std::uint32_t block) { return block % 2 == 0; });
  const NoiseLaw first = fitted(before, fitted_half);
  const NoiseLaw second = fitted(after, fitted_half);
  const auto rest = some_of(errors, [](std::uint32_t block) { return block % 2 == 1; });
  std::vector<double> without;
  std::vector<double> with;
  for (std::size_t i = 0; i < rest.size(); ++i) {
    without.push_back(first.log_density(double{rest.value[i]}, double{rest.range[i]}, rest.beam[i]));
    with.push_back(second.log_density(double{rest.value[i]}, double{rest.range[i]}, rest.beam[i]));
  }
  return likelihood_gain(without, with, rest.block, seed);
}

/// A way of not being normal that has been tried beside what the law already has.
struct Tried {
  std::size_t way = 0;
  NoiseLaw law;
  double rise = 0;  // of BIC
  double lead = 0;  // over the next best
};

Tried best_of(const std::vector<Way>& ways, const NoiseLaw& law, const RangeErrors& errors) {
  const double before = 2 * log_likelihood(law, errors) - price(law, errors);
  Tried best;
  for (std::size_t w = 0; w < ways.size(); ++w) {
    Tried one{.way = w, .law = law};
    ways[w].add(one.law);
    one.law = fitted(one.law, errors);
    one.rise = 2 * log_likelihood(one.law, errors) - price(one.law, errors) - before;
    one.lead = one.rise - best.rise;
    if (one.rise > best.rise) {
      best = std::move(one);
    } else {
      best.lead = std::min(best.lead, best.rise - one.rise);
    }
  }
  return best;
}

double p_value_of(const NoiseLaw& before, const NoiseLaw& after, const RangeErrors& errors) {
  const auto beams = static_cast<double>(beams_in(errors).size());
  const auto count = [&](const NoiseLaw& law) {
    return (law.has_slope ? 1 : 0) + (law.has_tail ? 2 : 0) + (law.has_peaks() ? 1 + beams : 0) +
           (law.has_spread() ? beams : 0);
  };
  const double fall = 2 * (log_likelihood(after, errors) - log_likelihood(before, errors));
  return fall > 0 ? cdf(complement(boost::math::chi_squared(count(after) - count(before)), fall)) : 1;
}

Finding finding_of(const std::string& scope, const Way& way, const Tried& tried, const NoiseLaw& before,
                   const RangeErrors& errors, std::uint64_t seed) {
  Finding finding{.cause = way.cause,
                  .scope = scope,
                  .parameters = way.parameters(tried.law),
                  .log10_odds = tried.lead / 2 / std::numbers::ln10,
                  .p_value = p_value_of(before, tried.law, errors),
                  .confounded_with = {},
                  .gain = {gain_of(before, tried.law, errors, seed)}};
  finding.accepted = finding.gain[0].surely_rises();
  add_errors(tried.law, errors, way, finding.parameters);
  return finding;
}

UnnamedFinding unnamed_of(const Finding& finding, const NoiseLaw& law) {
  double squares = 0;
  for (const double spread : law.spread) squares += std::pow(law.sigma * (spread - 1), 2);
  return {.covariate = "beam",
          .quantity = "noise",
          .scope = finding.scope,
          .amplitude = std::sqrt(squares / static_cast<double>(law.spread.size())),
          .unit = "m",
          .p_value = finding.p_value,
          .gain = finding.gain,
          .accepted = finding.accepted};
}

}  // namespace

NoiseDiagnosis diagnose_noise(const std::string& scope, const RangeErrors& all, std::uint64_t seed,
                              double least_gain) {
  constexpr double kBic = 10;
  const RangeErrors errors = thinned(all);
  NoiseDiagnosis result{.plain = fitted({}, errors), .law = {}, .findings = {}, .unnamed = {}};
  result.law = result.plain;
  auto left = ways(errors, result.plain.sigma);
  while (!left.empty()) {
    const Tried best = best_of(left, result.law, errors);
    if (best.rise < kBic) break;
    const Finding finding = finding_of(scope, left[best.way], best, result.law, errors, seed);
    if (finding.gain[0].after - finding.gain[0].before < least_gain) break;
    if (finding.cause.empty()) {
      result.unnamed.push_back(unnamed_of(finding, best.law));
    } else {
      result.findings.push_back(finding);
    }
    if (finding.accepted) result.law = best.law;
    left.erase(left.begin() + static_cast<std::ptrdiff_t>(best.way));
  }
  return result;
}

}  // namespace crisp
