// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/simulate/noise.hpp"

#include <fmt/format.h>

#include <cmath>

#include <crisp/error.hpp>

namespace crisp::simulate {
namespace {

bool is_share(double value) { return value >= 0 && value <= 1; }

void check(const RangeSettings& range, const NoiseEffects& effects, const std::string& laser) {
  if (!(range.sigma >= 0 && range.quantum >= 0 && range.max_distance > 0)) {
    throw Error(fmt::format("the ranges have sigma {:g} m, quantum {:g} m and max_range {:g} m", range.sigma,
                            range.quantum, range.max_distance),
                "give sigma and quantum of 0 m or more, and max_range above 0 m");
  }
  if (!(effects.sigma >= 0 && effects.slope >= 0 && effects.spread >= 0 && effects.jitter >= 0 &&
        effects.tail_scale >= 0 && effects.divergence >= 0 && effects.aperture >= 0 && effects.merge >= 0 &&
        effects.separation >= 0 && effects.step >= 0)) {
    throw Error("a parameter of the noise of " + laser + " is below 0",
                "give the effects noise.* values of 0 or more");
  }
  if (!is_share(effects.tail_share) || !is_share(effects.least_weight) || !is_share(effects.most_weight) ||
      effects.least_weight > effects.most_weight) {
    throw Error(fmt::format("the noise of {} has shares of {:g} (heavy_tail), {:g} and {:g} (two_peaks)",
                            laser, effects.tail_share, effects.least_weight, effects.most_weight),
                "give shares from 0 to 1, and two_peaks.least not above two_peaks.most");
  }
}

}  // namespace

RangeNoise::RangeNoise(const RangeSettings& range, const NoiseEffects& effects, std::uint64_t seed,
                       const std::string& laser)
    : sizes_{effects.sigma > 0 ? effects.sigma : range.sigma, effects.slope, effects.spread, effects.jitter},
      quantum_(effects.step > 0 ? effects.step : range.quantum),
      effects_(effects),
      normal_(seed, laser + ".noise"),
      tail_(seed, laser + ".noise.tail"),
      peak_(seed, laser + ".noise.peaks"),
      weight_(seed, laser + ".noise.weights") {
  check(range, effects, laser);
}

double RangeNoise::weight_of(std::uint16_t beam) {
  while (weights_.size() <= beam) {
    weights_.push_back(weight_.uniform(effects_.least_weight, effects_.most_weight));
  }
  return weights_[beam];
}

RangeNoise::Draw RangeNoise::draw(std::uint16_t beam) {
  Draw draw{.normal = normal_.normal()};
  if (effects_.tail_share > 0 && tail_.chance(effects_.tail_share)) draw.normal *= effects_.tail_scale;
  if (effects_.separation != 0) {
    draw.shift = effects_.separation * (peak_.chance(weight_of(beam)) ? 0.5 : -0.5);
  }
  return draw;
}

double RangeNoise::reported(const model::EchoConditions& echo, const Draw& draw) const {
  const double noisy = echo.range + draw.shift + model::deviation(sizes_, echo) * draw.normal;
  return quantum_ > 0 ? quantum_ * std::round(noisy / quantum_) : noisy;
}

}  // namespace crisp::simulate
