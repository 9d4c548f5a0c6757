// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/diagnose/noise_doubts.hpp"

#include <cmath>

namespace crisp {
namespace {

/// Whether what it is told by, its first parameter, is two of its standard errors from nothing.
bool is_borne_out(const Finding& found) {
  constexpr double kErrors = 2;
  const Parameter& first = found.parameters.front();
  return !(first.value < kErrors * first.std_error);
}

/// [m²] By how much it makes ranges scatter.
double added_by(const NoiseWay& way, const NoiseLaw& law, const RangeErrors& errors) {
  NoiseLaw without = law;
  way.take_away(without);
  double added = 0;
  for (std::size_t i = 0; i < errors.size(); ++i) {
    const EchoConditions echo = errors.echo(i);
    added += law.variance(echo, errors.beam[i]) - without.variance(echo, errors.beam[i]);
  }
  return added / static_cast<double>(errors.size());
}

}  // namespace

double shared_by_neighbours(const RangeErrors& errors, const NoiseLaw& law) {
  constexpr double kFarthest = 4;  // standard deviations: what is farther says of itself alone
  const auto is_near = [&](std::size_t i) {
    const double square = std::pow(double{errors.value[i]}, 2);
    return square < std::pow(kFarthest, 2) * law.variance(errors.echo(i), errors.beam[i]);
  };
  double sum = 0;
  double pairs = 0;
  for (std::size_t i = 1; i < errors.size(); ++i) {
    const bool follow = errors.beam[i] == errors.beam[i - 1] + 1 && errors.block[i] == errors.block[i - 1];
    if (!follow || !is_near(i - 1) || !is_near(i)) continue;
    sum += double{errors.value[i - 1]} * double{errors.value[i]};
    pairs += 1;
  }
  return pairs > 0 ? sum / pairs : 0;
}

std::string refusal_of(const Finding& found, const NoiseWay& way, const NoiseLaw& law,
                       const RangeErrors& errors) {
  constexpr double kTimesShared = 4;  // an eccentric encoder in the street: 2.8, in the office 1.5
  if (!is_borne_out(found)) return "parts of the recording do not agree that it is there at all";
  if (added_by(way, law, errors) < kTimesShared * shared_by_neighbours(errors, law)) {
    return "beams side by side are off together by as much: what the model leaves is no noise";
  }
  return {};
}

}  // namespace crisp
