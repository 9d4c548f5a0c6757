// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/diagnose/noise/component_checks.hpp"

#include <cmath>

namespace crisp::diagnose {
namespace {

/// Whether the first parameter, the size, exceeds two of its standard errors.
bool is_significant(const Finding& found) {
  constexpr double kErrors = 2;
  const Parameter& first = found.parameters.front();
  return !(first.value < kErrors * first.std_error);
}

/// [m²] Mean variance that the component contributes.
double added_by(const NoiseComponent& component, const NoiseModel& model, const RangeErrors& errors) {
  NoiseModel without = model;
  component.remove(without);
  double added = 0;
  for (std::size_t i = 0; i < errors.size(); ++i) {
    const model::EchoConditions echo = errors.echo(i);
    added += model.variance(echo, errors.beam[i]) - without.variance(echo, errors.beam[i]);
  }
  return added / static_cast<double>(errors.size());
}

}  // namespace

double shared_by_neighbours(const RangeErrors& errors, const NoiseModel& model) {
  constexpr double kFarthest = 4;  // standard deviations: outliers are no common-mode error
  const auto is_near = [&](std::size_t i) {
    const double square = std::pow(double{errors.value[i]}, 2);
    return square < std::pow(kFarthest, 2) * model.variance(errors.echo(i), errors.beam[i]);
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

std::string rejection_reason(const Finding& found, const NoiseComponent& component, const NoiseModel& model,
                             const RangeErrors& errors) {
  constexpr double kTimesShared =
      4;  // observed with an eccentric encoder: 2.8 in the street, 1.5 in the office
  if (!is_significant(found)) return "it is not significant over the parts of the recording (jackknife)";
  if (added_by(component, model, errors) < kTimesShared * shared_by_neighbours(errors, model)) {
    return "neighbouring beams share errors of that size, so the residual is not independent noise";
  }
  return {};
}

}  // namespace crisp::diagnose
