// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/model/terms/empirical.hpp"

#include <fmt/format.h>

#include <cmath>

#include "pipeline/data/degree.hpp"
#include "pipeline/model/terms/register_terms.hpp"

namespace crisp::model {
namespace {

using On = EmpiricalTerm::On;
using Over = EmpiricalTerm::Over;

struct OnName {
  std::string name;
  std::string unit;
  double bound;
  Phase phase;
  Scope scope;
};

OnName describe(On on) {
  switch (on) {
    case On::kRange:
      return {"range", "m", 0.5, Phase::kRange, Scope::kLaser};
    case On::kMirrorAngle:
      return {"mirror angle", "rad", 0.1, Phase::kMirror, Scope::kLaser};
    case On::kElevation:
      return {"elevation", "rad", 0.1, Phase::kBeam, Scope::kLaser};
    case On::kPlateAngle:
      return {"plate angle", "rad", 0.1, Phase::kPlate, Scope::kPlate};
    case On::kLag:
      return {"lag", "s", 0.01, Phase::kTime, Scope::kLaser};
    case On::kBase:
      return {"base", "m", 0.5, Phase::kBase, Scope::kPlate};
    case On::kTilt:
      return {"tilt", "rad", 0.1, Phase::kBase, Scope::kPlate};
  }
  return {};
}

std::string name_of(Over over) {
  switch (over) {
    case Over::kMirrorAngle:
      return "mirror angle";
    case Over::kPlateAngle:
      return "plate angle";
    case Over::kRange:
      return "range";
    case Over::kIncidence:
      return "incidence";
    case Over::kRemission:
      return "remission";
    case Over::kTime:
      return "time";
    case Over::kPlateRate:
      return "plate rate";
    case Over::kRangePhase:
      return "range phase";
  }
  return {};
}

std::string underscored(std::string words) {
  std::ranges::replace(words, ' ', '_');
  return words;
}

EffectParameter span_of_time() {
  return {.name = "span",
          .unit = "s",
          .lower = 1e-3,
          .upper = 1e7,
          .neutral = 10,
          .summary = "covariate of the shape",
          .shape = true,
          .tries = {.spacing = Tries::Spacing::kInstants, .from = 1, .to = 1, .count = 1}};
}

EffectParameter period_of_range() {
  return {.name = "P",
          .unit = "m",
          .lower = 0.05,
          .upper = 50,
          .neutral = 4,
          .summary = "period",
          .shape = true,
          .tries = {.spacing = Tries::Spacing::kOfSimpleForm, .from = 0.5, .to = 16, .count = 1}};
}

/// What a bearing does over the plate's angle about the spin axis is an error of the encoder.
std::vector<std::string> axes_of(On on, Over over) {
  if (on == On::kTilt && over == Over::kPlateAngle) return {"x_", "y_"};
  if (on == On::kTilt || on == On::kBase) return {"x_", "y_", "z_"};
  return {""};
}

std::vector<EffectParameter> parameters(On on, Over over, const Shape& shape) {
  const OnName what = describe(on);
  const std::vector<std::string> axes = axes_of(on, over);
  constexpr double kOfPeriodic = 0.2;  // as range.cyclic: a distance must have one range
  const double bound = what.bound * shape.scale() * (over == Over::kRangePhase ? kOfPeriodic : 1);
  std::vector<EffectParameter> all;
  for (const std::string& axis : axes) {
    for (std::size_t k = 0; k < shape.coefficients(); ++k) {
      all.push_back({.name = axis + shape.name(k),
                     .unit = what.unit,
                     .lower = -bound,
                     .upper = bound,
                     .summary = shape.summary(k)});
    }
  }
  if (over == Over::kTime) all.push_back(span_of_time());
  if (over == Over::kRangePhase) all.push_back(period_of_range());
  return all;
}

std::vector<double> evenly(double from, double to, int count) {
  std::vector<double> knots;
  for (int k = 0; k < count; ++k) knots.push_back(std::lerp(from, to, static_cast<double>(k) / (count - 1)));
  return knots;
}

/// [m] Evenly at first, then ever farther apart.
std::vector<double> finer_ranges() {
  std::vector<double> knots = evenly(0.5, 6, 12);
  while (knots.back() < 40) knots.push_back(1.2 * knots.back());
  return knots;
}

}  // namespace

void EmpiricalTerm::apply(std::span<Beam<double>> beams, std::span<const double> parameters) const {
  for (auto& beam : beams) change(beam, parameters);
}

void EmpiricalTerm::apply(std::span<Beam<Jet>> beams, std::span<const Jet> parameters) const {
  const bool has_derivatives =
      std::ranges::any_of(parameters, [](const Jet& parameter) { return !parameter.v.isZero(0); });
  if (has_derivatives) {
    for (auto& beam : beams) change(beam, parameters);
    return;
  }
  std::vector<double> values;
  for (const Jet& parameter : parameters) values.push_back(parameter.a);
  for (auto& beam : beams) change(beam, std::span<const double>(values));
}

EmpiricalTerm::EmpiricalTerm(On on, Over over, Shape shape, std::string family)
    : on_(on), over_(over), shape_(std::move(shape)) {
  const OnName what = describe(on);
  const std::string of = name_of(over);
  info_ = {
      .name = "empirical." + underscored(what.name) + "_by_" + underscored(of) + shape_.suffix(),
      .summary = what.name + " is off by a function of " + of +
                 (family.empty() ? " that no cause explains" : ": the general form of " + family),
      .phase = what.phase,
      .scope = what.scope,
      .parameters = parameters(on, over, shape_),
      .details =
          (family.empty()
               ? "An empirical shape without a cause, for departures that no other effect of the catalogue describes"
               : "An empirical shape, reported as " + family +
                     ": for departures of this cause that its own formula does not describe") +
          "; x is the " + of +
          (over == Over::kTime         ? " as a share of `span`"
           : over == Over::kRemission  ? "'s logarithm"
           : over == Over::kIncidence  ? " β as √(−ln cos β), in which both 1/cos β and β are smooth"
           : over == Over::kRange      ? " [m]"
           : over == Over::kPlateRate  ? " [rad/s]"
           : over == Over::kRangePhase ? " 2πr/P [rad]"
                                       : " [rad]") +
          ".",
      .counts_from = over == Over::kTime         ? CountsFrom::kRunsEpoch
                     : over == Over::kPlateAngle ? CountsFrom::kEncodersZero
                                                 : CountsFrom::kNothing,
      .needs_incidence = over == Over::kIncidence,
      .covariate = of,
      .family = std::move(family),
      .is_fine = shape_.is_fine()};
}

void register_empirical_terms(TermRegistry& terms) {
  const auto add = [&](On on, Over over, Shape shape, const std::string& family = {}) {
    terms.add(std::make_shared<EmpiricalTerm>(on, over, std::move(shape), family));
  };
  const Shape in_time = Shape::splines(8, 0, 1, 0.5);
  constexpr double kGrazing = 1.8;  // of 87.7°
  const double dark = std::log(8.0), usual = std::log(100.0), bright = std::log(254.0);
  // General members of families, by what they act on and what over.
  add(On::kRange, Over::kIncidence, Shape::splines(6, 0, kGrazing, 0), "range.incidence");
  add(On::kRange, Over::kRemission, Shape::splines(6, dark, bright, usual), "range.intensity");
  add(On::kRange, Over::kTime, in_time, "range.warmup");
  add(On::kRange, Over::kRangePhase, Shape::fourier(1, 6), "range.cyclic");
  add(On::kMirrorAngle, Over::kMirrorAngle, Shape::fourier(1, 4), "mirror.eccentricity");
  add(On::kElevation, Over::kMirrorAngle, Shape::fourier(2, 4),
      "mirror.cone");  // once a turn: the mount's tilt
  add(On::kLag, Over::kTime, in_time, "clock.drift");
  add(On::kPlateAngle, Over::kPlateAngle, Shape::fourier(1, 6), "encoder.eccentricity");
  add(On::kPlateAngle, Over::kPlateRate, Shape::powers(), "encoder.speed_lag");
  add(On::kBase, Over::kPlateAngle, Shape::fourier(1, 2), "plate.wobble");
  add(On::kTilt, Over::kPlateAngle, Shape::fourier(1, 2), "plate.wobble");
  add(On::kBase, Over::kTime, in_time, "base.motion");
  add(On::kTilt, Over::kTime, in_time, "base.motion");
  // Departures whose invariances are those of no cause.
  add(On::kRange, Over::kMirrorAngle, Shape::fourier(1, 4));
  add(On::kRange, Over::kPlateAngle, Shape::fourier(1, 4));
  add(On::kRange, Over::kRange, Shape::curve());
  add(On::kRange, Over::kRange, Shape::hats({1, 2, 3, 4, 6, 8, 12, 20}));
  add(On::kRange, Over::kPlateRate, Shape::powers());
  add(On::kPlateAngle, Over::kTime, in_time);
  add(On::kRange, Over::kMirrorAngle,
      Shape::hats(evenly(-180 * data::kDegree, 180 * data::kDegree, 49)).finely());
  add(On::kRange, Over::kRange, Shape::hats(finer_ranges()).finely());
  add(On::kRange, Over::kIncidence, Shape::splines(16, 0, kGrazing, 0).finely(), "range.incidence");
  add(On::kRange, Over::kRemission, Shape::splines(16, dark, bright, usual).finely(), "range.intensity");
  add(On::kRange, Over::kTime, Shape::splines(34, 0, 1, 0.5).finely());
  add(On::kRange, Over::kPlateRate, Shape::hats(evenly(-12.5, 12.5, 26)).finely());
}

}  // namespace crisp::model
