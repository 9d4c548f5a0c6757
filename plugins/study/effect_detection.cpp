// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/study/effect_detection.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>

#include "pipeline/data/degree.hpp"
#include "pipeline/estimate/free_parameters.hpp"
#include "pipeline/estimate/identifiability.hpp"
#include "pipeline/estimate/surfel_refinement.hpp"
#include "plugins/diagnose/model/candidate_search.hpp"
#include "plugins/study/beam_choice.hpp"

namespace crisp::study {
namespace {

/// [mm, °, or SI] An amount with its unit, for people.
std::string in_words(double value, const std::string& unit) {
  if (unit == "m") return fmt::format("{:.2g} mm", 1e3 * value);
  if (unit == "rad") return fmt::format("{:.2g} deg", value / data::kDegree);
  if (unit == "s") return fmt::format("{:.2g} ms", 1e3 * value);
  return fmt::format("{:.2g}{}{}", value, unit == "1" ? "" : " ", unit == "1" ? "" : unit);
}

std::string size_text(double size, const diagnose::EffectResolution& effect) {
  if (!std::isfinite(size)) return "never";
  const std::string text = fmt::format("{:.2g} mm", 1e3 * size);
  return effect.parameter.empty() ? text
                                  : fmt::format("{} ({} {})", text, effect.parameter,
                                                in_words(size * effect.per_metre, effect.unit));
}

std::string csv_number(double value) { return std::isfinite(value) ? fmt::format("{:.6g}", value) : ""; }

}  // namespace

EffectDetection effect_detection(const simulate::ScannerSettings& scanner, const simulate::Scene& scene,
                                 const simulate::Motion& motion, const TermRegistry& terms) {
  diagnose::DiagnosisSettings diagnosis;
  diagnosis.refinement.surfels.noise = scanner.range.sigma;
  const auto simulated = simulate_beams(BeamChoice::kAll, scanner, scene, motion, terms);
  const SensorModel truth(simulated.truth, terms);
  const estimate::LagRange lags = estimate::lag_range(truth, 0);
  const estimate::Sample sample = estimate::placeable(
      truth,
      estimate::covered({.beams = simulated.beams, .plate = &simulated.plate}, lags.earliest, lags.latest));
  const diagnose::SurfaceObservations observations(truth, sample, diagnosis.refinement, diagnosis.beams);
  const estimate::FreeParameters base =
      estimate::identifiable_parameters(estimate::free_parameters(truth, sample.beams, {}), truth,
                                        observations.sample(), estimate::ParameterPrior{});
  const diagnose::CandidateJacobian jacobian(
      truth, base.free,
      diagnose::typical_causes(diagnose::candidates(terms, simulated.truth, observations.coverage())), terms);
  const quality::NormalEquations equations = observations.equations(jacobian, diagnosis.beams);
  return {.effects = diagnose::effect_resolutions(
              jacobian, diagnose::planned_with(equations, static_cast<double>(equations.beams)),
              diagnosis.selection),
          .beams = equations.beams,
          .surfaces = observations.surfels().surfels.size()};
}

std::string effects_text(const EffectDetection& bound) {
  std::string text = fmt::format("{:<32}{:<28}{:<28}{}", "effect (RMS change of ranges)", "detectable from",
                                 "resolvable from", "below that it could be");
  for (const diagnose::EffectResolution& effect : bound.effects) {
    text += fmt::format("\n{:<32}{:<28}{:<28}{}", effect.cause, size_text(effect.detectable, effect),
                        size_text(effect.resolvable, effect), fmt::join(effect.confounded_with, ", "));
  }
  return text;
}

std::string effects_csv(const EffectDetection& bound) {
  std::string text = "effect,detectable,resolvable,parameter,unit,parameter_per_metre,confounded_with\n";
  for (const diagnose::EffectResolution& effect : bound.effects) {
    text += fmt::format("{},{},{},{},{},{},{}\n", effect.cause, csv_number(effect.detectable),
                        csv_number(effect.resolvable), effect.parameter, effect.unit,
                        effect.parameter.empty() ? "" : csv_number(effect.per_metre),
                        fmt::join(effect.confounded_with, " "));
  }
  return text;
}

}  // namespace crisp::study
