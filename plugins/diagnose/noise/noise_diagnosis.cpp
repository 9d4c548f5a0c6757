// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/diagnose/noise/noise_diagnosis.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>

#include "plugins/diagnose/noise/component_checks.hpp"
#include "plugins/diagnose/noise/expectation_step.hpp"
#include "plugins/diagnose/noise/jackknife.hpp"
#include "plugins/diagnose/noise/likelihood_gain.hpp"
#include "plugins/diagnose/noise/noise_components.hpp"

namespace crisp::diagnose {
namespace {

constexpr double kBic = 10;  // minimum decrease of the BIC

double log_likelihood(const NoiseModel& model, const RangeErrors& errors) {
  const auto logarithms = ExpectationStep(errors).log_densities(model);
  return std::accumulate(logarithms.begin(), logarithms.end(), 0.0);
}

std::map<std::uint16_t, double> beams_in(const RangeErrors& errors) {
  std::map<std::uint16_t, double> counts;
  for (const std::uint16_t beam : errors.beam) counts[beam] += 1;
  return counts;
}

/// Number of a noise model's parameters: those shared by all ranges, and those of each beam.
struct DegreesOfFreedom {
  double of_all = 0, of_each = 0;
};

DegreesOfFreedom degrees_of_freedom_of(const NoiseModel& model) {
  const auto parts = static_cast<double>(std::ranges::count(model.parts, true));
  return {.of_all = parts + (model.has_tail ? 2 : 0) + (model.has_peaks() ? 1 : 0),
          .of_each = (model.has_peaks() ? 1.0 : 0.0) + (model.has_relative() ? 1 : 0)};
}

/// Twice the log-likelihood less the BIC's penalty: ln of the number of ranges that determine each parameter.
double bic_of(const NoiseModel& model, const RangeErrors& errors) {
  const DegreesOfFreedom degrees_of_freedom = degrees_of_freedom_of(model);
  double price = degrees_of_freedom.of_all * std::log(static_cast<double>(errors.size()));
  for (const auto& [beam, count] : beams_in(errors)) price += degrees_of_freedom.of_each * std::log(count);
  return 2 * log_likelihood(model, errors) - price;
}

/// Held-out gain: mean log-likelihood of every other block under models that were fitted to the rest.
Gain gain_of(const NoiseModel& before, const NoiseModel& after, const RangeErrors& errors,
             std::uint64_t seed) {
  const auto fitted_half = select(errors, [&](std::size_t i) { return errors.block[i] % 2 == 0; });
  const NoiseModel first = fitted(before, fitted_half);
  const NoiseModel second = fitted(after, fitted_half);
  const auto rest = select(errors, [&](std::size_t i) { return errors.block[i] % 2 == 1; });
  const ExpectationStep step(rest);
  const auto without = step.log_densities(first);
  const auto with = step.log_densities(second);
  return likelihood_gain(without, with, rest.block, seed);
}

/// A noise component that was fitted in addition to the current model.
struct ComponentFit {
  std::size_t component = 0;
  NoiseModel model;
  double rise = 0;                       // decrease of the BIC
  double lead = 0;                       // difference in BIC to the next best
  std::vector<std::string> as_probable;  // causes that are not resolvable (Bayes factor below 100)
  std::vector<OtherCause> others;        // all other causes, the most likely first
};

ComponentFit best_of(const std::string& scope, const std::vector<NoiseComponent>& components,
                     const NoiseModel& model, const RangeErrors& errors) {
  constexpr double kOdds = 9.2;  // difference in BIC: Bayes factor 100
  const double before = bic_of(model, errors);
  std::vector<double> rises;
  ComponentFit best;
  for (std::size_t w = 0; w < components.size(); ++w) {
    NoiseModel one = model;
    components[w].add(one);
    one = fitted(one, errors);
    rises.push_back(bic_of(one, errors) - before);
    if (rises.back() > best.rise) best = {.component = w, .model = std::move(one), .rise = rises.back()};
  }
  best.lead = best.rise;
  for (std::size_t w = 0; w < components.size(); ++w) {
    if (w == best.component) continue;
    best.lead = std::min(best.lead, best.rise - rises[w]);
    if (components[w].cause.empty()) continue;
    const double behind = best.rise - rises[w];
    if (rises[w] > 0 && behind < kOdds) best.as_probable.push_back(components[w].cause);
    best.others.push_back({.cause = components[w].cause,
                           .scope = scope,
                           .log10_bayes_factor = behind / 2 / std::numbers::ln10});
  }
  std::ranges::stable_sort(best.others, {}, &OtherCause::log10_bayes_factor);
  return best;
}

double p_value_of(const NoiseModel& before, const NoiseModel& after, const RangeErrors& errors) {
  const auto beams = static_cast<double>(beams_in(errors).size());
  const auto count = [&](const NoiseModel& model) {
    const DegreesOfFreedom degrees_of_freedom = degrees_of_freedom_of(model);
    return degrees_of_freedom.of_all + beams * degrees_of_freedom.of_each;
  };
  const double fall = 2 * (log_likelihood(after, errors) - log_likelihood(before, errors));
  return fall > 0 ? cdf(complement(boost::math::chi_squared(count(after) - count(before)), fall)) : 1;
}

/// A selected noise component with its finding, yet without parameters.
struct SelectedComponent {
  NoiseComponent component;
  NoiseModel model;  // at its selection
  Finding finding;

  bool is_cause() const { return !component.cause.empty(); }
};

SelectedComponent found_of(const std::string& scope, const NoiseComponent& component,
                           const ComponentFit& tried, const NoiseModel& before, const RangeErrors& errors,
                           std::uint64_t seed) {
  Finding finding{.cause = component.cause,
                  .scope = scope,
                  .parameters = {},
                  .log10_bayes_factor = tried.lead / 2 / std::numbers::ln10,
                  .p_value = p_value_of(before, tried.model, errors),
                  .confounded_with = {},
                  .alternatives = tried.others,
                  .gain = {gain_of(before, tried.model, errors, seed)}};
  for (const std::string& cause : tried.as_probable) {
    finding.confounded_with.push_back(fmt::format("{}.{}", scope, cause));
  }
  finding.accepted = finding.gain[0].significant_increase();
  return {.component = component, .model = tried.model, .finding = std::move(finding)};
}

/// Backward elimination: removes components that the last one has made needless.
void eliminate_needless(std::vector<SelectedComponent>& found, NoiseModel& model, const RangeErrors& errors,
                        double least_rise) {
  for (std::size_t k = 0; k + 1 < found.size();) {
    NoiseModel without = model;
    found[k].component.remove(without);
    without = fitted(without, errors);
    if (!found[k].finding.accepted || bic_of(model, errors) - bic_of(without, errors) >= least_rise) {
      ++k;
      continue;
    }
    model = std::move(without);
    found.erase(found.begin() + static_cast<std::ptrdiff_t>(k));
  }
}

UnnamedFinding unnamed_of(const Finding& finding, const NoiseModel& model, const RangeErrors& errors) {
  double squares = 0;
  for (std::size_t i = 0; i < errors.size(); ++i) {
    squares +=
        std::pow(model::deviation(model.size, errors.echo(i)) * (model.relative[errors.beam[i]] - 1), 2);
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

/// @param named  the model at the last cause's selection. Unnamed components found later are not simulated,
/// so
///               the causes are estimated without them
void report(std::vector<SelectedComponent> found, const NoiseModel& named, const RangeErrors& errors,
            NoiseDiagnosis& to) {
  const bool is_requested = std::ranges::any_of(
      found, [](const SelectedComponent& one) { return one.is_cause() && one.finding.accepted; });
  const JackknifedModel fits = is_requested ? in_parts(named, errors) : JackknifedModel{};
  for (SelectedComponent& one : found) {
    if (!one.is_cause()) {
      to.unnamed.push_back(unnamed_of(one.finding, one.model, errors));
      continue;
    }
    one.finding.parameters = one.finding.accepted ? parameters_of(one.component, fits)
                                                  : parameters_of(one.component, in_parts(one.model, errors));
    if (one.finding.accepted)
      one.finding.rejection = rejection_reason(one.finding, one.component, named, errors);
    if (!one.finding.rejection.empty()) {
      one.finding.accepted = false;
      one.component.remove(to.model);
      to.model = fitted(to.model, errors);
    }
    to.findings.push_back(std::move(one.finding));
  }
}

}  // namespace

NoiseDiagnosis diagnose_noise(const std::string& scope, const RangeErrors& all, std::uint64_t seed,
                              double least_gain) {
  constexpr std::size_t kMax = 120'000;  // sufficient for all components
  const RangeErrors errors = thinned(all, kMax);
  NoiseDiagnosis result{.plain = fitted({}, errors), .model = {}, .findings = {}, .unnamed = {}};
  result.model = result.plain;
  NoiseModel named = result.plain;
  const double least_rise = std::max(kBic, 2 * least_gain * static_cast<double>(errors.size()));
  auto left = noise_components(all, result.plain.sigma());  // from all ranges, so that it covers all beams
  std::vector<SelectedComponent> found;
  while (!left.empty()) {
    const ComponentFit best = best_of(scope, left, result.model, errors);
    if (best.rise < kBic) break;
    SelectedComponent one = found_of(scope, left[best.component], best, result.model, errors, seed);
    if (one.finding.gain[0].after - one.finding.gain[0].before < least_gain) break;
    left.erase(left.begin() + static_cast<std::ptrdiff_t>(best.component));
    found.push_back(std::move(one));
    if (!found.back().finding.accepted) continue;
    result.model = best.model;
    eliminate_needless(found, result.model, errors, least_rise);
    if (found.back().is_cause()) named = result.model;
  }
  report(std::move(found), named, errors, result);
  return result;
}

}  // namespace crisp::diagnose
