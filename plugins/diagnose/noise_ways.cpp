// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/diagnose/noise_ways.hpp"

#include <algorithm>

#include "plugins/diagnose/peak_weights.hpp"

namespace crisp {
namespace {

NoiseWay growing(const char* cause, VariancePart part, const char* parameter, const char* unit) {
  const auto index = static_cast<std::size_t>(part);
  return {.cause = cause,
          .add = [index](NoiseLaw& law) { law.parts[index] = true; },
          .take_away =
              [index](NoiseLaw& law) {
                law.parts[index] = false;
                law.size[index] = 0;
              },
          .parameters =
              [=](const NoiseLaw& law) {
                return std::vector<Parameter>{{.name = parameter, .unit = unit, .value = law.size[index]}};
              }};
}

NoiseWay each_beam_its_own(std::size_t beams) {
  return {.cause = "",  // of what it meets or of itself
          .add = [beams](NoiseLaw& law) { law.relative.assign(beams, 1); },
          .take_away = [](NoiseLaw& law) { law.relative.clear(); },
          .parameters = [](const NoiseLaw&) { return std::vector<Parameter>{}; }};
}

NoiseWay heavy_tail() {
  return {.cause = "noise.heavy_tail",
          .add =
              [](NoiseLaw& law) {
                law.has_tail = true;
                law.tail_share = 0.02;
              },
          .take_away = [](NoiseLaw& law) { law.has_tail = false; },
          .parameters =
              [](const NoiseLaw& law) {
                return std::vector<Parameter>{{.name = "share", .unit = "1", .value = law.tail_share},
                                              {.name = "scale", .unit = "1", .value = law.tail_scale}};
              }};
}

NoiseWay two_peaks(std::size_t beams, double sigma) {
  return {.cause = "noise.two_peaks",
          .add =
              [beams, sigma](NoiseLaw& law) {
                law.weight.assign(beams, 0.5);
                law.separation = 1.6 * sigma;
                law.size[0] = 0.6 * sigma;
              },
          .take_away =
              [](NoiseLaw& law) {
                law.weight.clear();
                law.separation = 0;
              },
          .parameters =
              [](const NoiseLaw& law) {
                return std::vector<Parameter>{{.name = "separation", .unit = "m", .value = law.separation}};
              },
          .told_by_ranges =
              [](const NoiseLaw& law, const RangeErrors& errors) {
                const WeightLimits limits = weight_limits(law, errors);
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

std::vector<NoiseWay> noise_ways(const RangeErrors& errors, double sigma) {
  const std::size_t beams = beams_of(errors);
  std::vector<NoiseWay> ways = {each_beam_its_own(beams), heavy_tail(), two_peaks(beams, sigma)};
  const auto add_if_seen = [&](std::span<const float> values, NoiseWay way) {
    if (are_various(values)) ways.push_back(std::move(way));
  };
  add_if_seen(errors.range, growing("noise.range_dependent", VariancePart::kRange, "slope", "1"));
  add_if_seen(errors.cosine, growing("noise.incidence_dependent", VariancePart::kIncidence, "spread", "m"));
  add_if_seen(errors.remission,
              growing("noise.remission_dependent", VariancePart::kRemission, "jitter", "m"));
  return ways;
}

}  // namespace crisp
