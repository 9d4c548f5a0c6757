// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/diagnose/noise/noise_components.hpp"

#include <algorithm>

#include "plugins/diagnose/noise/peak_weights.hpp"

namespace crisp::diagnose {
namespace {

NoiseComponent growing(const char* cause, model::VariancePart part, const char* parameter, const char* unit) {
  const auto index = static_cast<std::size_t>(part);
  return {.cause = cause,
          .add = [index](NoiseModel& model) { model.parts[index] = true; },
          .remove =
              [index](NoiseModel& model) {
                model.parts[index] = false;
                model.size[index] = 0;
              },
          .parameters =
              [=](const NoiseModel& model) {
                return std::vector<Parameter>{{.name = parameter, .unit = unit, .value = model.size[index]}};
              }};
}

NoiseComponent each_beam_its_own(std::size_t beams) {
  return {.cause = "",  // of the surface or of the beam, which the ranges do not resolve
          .add = [beams](NoiseModel& model) { model.relative.assign(beams, 1); },
          .remove = [](NoiseModel& model) { model.relative.clear(); },
          .parameters = [](const NoiseModel&) { return std::vector<Parameter>{}; }};
}

NoiseComponent heavy_tail() {
  return {.cause = "noise.heavy_tail",
          .add =
              [](NoiseModel& model) {
                model.has_tail = true;
                model.tail_share = 0.02;
              },
          .remove = [](NoiseModel& model) { model.has_tail = false; },
          .parameters =
              [](const NoiseModel& model) {
                return std::vector<Parameter>{{.name = "share", .unit = "1", .value = model.tail_share},
                                              {.name = "scale", .unit = "1", .value = model.tail_scale}};
              }};
}

NoiseComponent two_peaks(std::size_t beams, double sigma) {
  return {.cause = "noise.two_peaks",
          .add =
              [beams, sigma](NoiseModel& model) {
                model.weight.assign(beams, 0.5);
                model.separation = 1.6 * sigma;
                model.size[0] = 0.6 * sigma;
              },
          .remove =
              [](NoiseModel& model) {
                model.weight.clear();
                model.separation = 0;
              },
          .parameters =
              [](const NoiseModel& model) {
                return std::vector<Parameter>{{.name = "separation", .unit = "m", .value = model.separation}};
              },
          .determined_by_ranges =
              [](const NoiseModel& model, const RangeErrors& errors) {
                const WeightLimits limits = weight_limits(model, errors);
                return std::vector<Parameter>{
                    {.name = "least", .unit = "1", .value = limits.least, .std_error = limits.least_error},
                    {.name = "most", .unit = "1", .value = limits.most, .std_error = limits.most_error}};
              }};
}

}  // namespace

bool are_various(std::span<const float> values) {
  if (values.empty()) return false;
  const auto [least, most] = std::ranges::minmax(values);
  return least < most;
}

std::vector<NoiseComponent> noise_components(const RangeErrors& errors, double sigma) {
  const std::size_t beams = beams_of(errors);
  std::vector<NoiseComponent> components = {each_beam_its_own(beams), heavy_tail(), two_peaks(beams, sigma)};
  const auto add_if_seen = [&](std::span<const float> values, NoiseComponent component) {
    if (are_various(values)) components.push_back(std::move(component));
  };
  add_if_seen(errors.range, growing("noise.range_dependent", model::VariancePart::kRange, "slope", "1"));
  add_if_seen(errors.cosine,
              growing("noise.incidence_dependent", model::VariancePart::kIncidence, "spread", "m"));
  add_if_seen(errors.remission,
              growing("noise.remission_dependent", model::VariancePart::kRemission, "jitter", "m"));
  return components;
}

}  // namespace crisp::diagnose
