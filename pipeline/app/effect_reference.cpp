// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/app/effect_reference.hpp"

#include <fmt/format.h>

namespace crisp::app {
namespace {

constexpr const char* kIntroduction =
    "# Effects\n\n"
    "Deviations of real scanners from equation (2) of Sheehan, Harrison and Newman, from ideal clocks and\n"
    "from plain noise. `crisp effects --markdown` writes this page from the effects' declarations; `crisp\n"
    "effects NAME` describes one effect, a plugin's too.\n\n"
    "The names are the same everywhere: in `effects` of grabber.simulate, in calibrations, in diagnoses. A\n"
    "parameter is the correction to be added to a reading: a laser with a range.offset of +2 mm reads 2 mm\n"
    "short. θ is the mirror's angle, φ the plate's, ω its rate, r the range, β the incidence, I the\n"
    "remission, k the number of a beam in its scan. \"Form\" marks shape parameters, which have no effect\n"
    "without the amplitudes. Neutral is the value without effect; a calibration keeps to the bounds.\n\n"
    "```yaml\n"
    "- stage: grabber.simulate\n"
    "  with:\n"
    "    effects:\n"
    "      encoder.eccentricity: {a: 0.1deg}\n"
    "      laser2.mirror.cone: {kappa: 0.3deg}     # one laser's; without an owner it is every laser's\n"
    "      plate.clock.drift: {skew: 20ppm}        # of a device's clock: a laser's or the plate's\n"
    "```\n";

std::string owner_of(Scope scope) {
  switch (scope) {
    case Scope::kLaser:
      return "each laser";
    case Scope::kPlate:
      return "the plate";
    case Scope::kDevice:
      return "each laser and the plate";
    case Scope::kScene:
      return "the scene";
  }
  return {};
}

std::string number(double value, const std::string& unit) {
  return fmt::format("{:g}{}{}", value, unit == "1" ? "" : " ", unit == "1" ? "" : unit);
}

std::string bounds(const EffectParameter& p) {
  return fmt::format("{:g} to {}", p.lower, number(p.upper, p.unit));
}

}  // namespace

std::string effect_text(const EffectInfo& effect) {
  std::string text = fmt::format("{}: {}\n\n{}\n\n  of {}\n", effect.name, effect.summary, effect.details,
                                 owner_of(effect.scope));
  if (!effect.resolvable_by.empty()) text += fmt::format("  resolvable by: {}\n", effect.resolvable_by);
  if (!effect.parameters.empty()) text += "\nparameters:\n";
  for (const auto& p : effect.parameters) {
    text += fmt::format("  {:<12} {}\n{:15}{}; neutral: {}{}\n", p.name, p.summary, "", bounds(p),
                        number(p.neutral, p.unit), p.shape ? "; form" : "");
  }
  return text;
}

std::string effects_markdown(const std::vector<EffectInfo>& catalogue) {
  std::string text = kIntroduction;
  std::string family;
  for (const auto& effect : catalogue) {
    const std::string of = effect.name.substr(0, effect.name.find('.'));
    if (of != family) text += fmt::format("\n## {}\n", of);
    family = of;
    text += fmt::format("\n### {}\n\nOf {}: {}.\n\n{}\n", effect.name, owner_of(effect.scope), effect.summary,
                        effect.details);
    if (!effect.resolvable_by.empty()) text += fmt::format("\nResolvable by: {}.\n", effect.resolvable_by);
    if (effect.parameters.empty()) continue;
    text += "\n| parameter | meaning | neutral | bounds | |\n|---|---|---|---|---|\n";
    for (const auto& p : effect.parameters) {
      text += fmt::format("| `{}` | {} | {} | {} | {} |\n", p.name, p.summary, number(p.neutral, p.unit),
                          bounds(p), p.shape ? "form" : "");
    }
  }
  return text;
}

}  // namespace crisp::app
