// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/estimate/identifiability.hpp"

#include "pipeline/estimate/base_parameters.hpp"
#include "pipeline/estimate/displacement.hpp"
#include "pipeline/estimate/observability.hpp"
#include "pipeline/estimate/requested_terms.hpp"

namespace crisp::estimate {
namespace {

constexpr double kMinMotion = 0.005;   // [m]
constexpr double kSpacing = 0.05;      // [s]
constexpr std::size_t kBeams = 20000;  // enough to see how points move

PlateTrajectory thinned(const PlateTrajectory& plate, double spacing) {
  std::vector<double> times;
  std::vector<double> angles;
  for (std::size_t i = 0; i < plate.size(); ++i) {
    const bool last_before_gap =
        i + 1 == plate.size() || plate.times()[i + 1] - plate.times()[i] > plate.max_gap();
    const bool first_after_gap = i == 0 || plate.times()[i] - plate.times()[i - 1] > plate.max_gap();
    if (!last_before_gap && !first_after_gap && plate.times()[i] - times.back() < spacing) continue;
    times.push_back(plate.times()[i]);
    angles.push_back(plate.angles()[i]);
  }
  return {plate.epoch_ns(), std::move(times), std::move(angles), spacing + plate.max_gap()};
}

/// The model with every free τ off by as much as it may be.
SensorModel farther_out(const SensorModel& model, const std::vector<std::size_t>& free,
                        const ParameterPrior& range) {
  Eigen::VectorXd values = model.values();
  for (std::size_t laser = 0; laser < model.lasers(); ++laser) {
    const std::size_t tau = slot(model, laser, kTau);
    if (is_free(free, tau)) values[static_cast<Eigen::Index>(tau)] += range.tau;
  }
  SensorModel moved = model;
  moved.set_values(values);
  return moved;
}

}  // namespace

FreeParameters identifiable_parameters(FreeParameters parameters, const SensorModel& model,
                                       const Sample& sample, const ParameterPrior& range) {
  std::vector<std::size_t> base = parameters.free;
  std::erase_if(base, [&](std::size_t parameter) { return declared(model, parameter) != nullptr; });
  if (base.empty()) return parameters;
  const PlateTrajectory plate = thinned(*sample.plate, kSpacing);
  Sample some = thin_evenly(sample, kBeams, 1);
  some.plate = &plate;
  const auto identified_at = [&](const SensorModel& place) {
    const Eigen::MatrixXd motion = displacement(place, some, base) / (kMinMotion * kMinMotion);
    return observability(motion, base, model.names(), ranges_of(range, model, base));
  };
  auto reported = identified_at(model);
  // A laser on the spin axis turns by α as by λ; but where it sits is still to be found.
  if (!reported.unobservable.empty()) reported = identified_at(farther_out(model, base, range));
  std::erase_if(parameters.free, [&](std::size_t parameter) {
    return std::ranges::find(base, parameter) != base.end() &&
           std::ranges::find(reported.known, parameter) == reported.known.end();
  });
  for (Unobservable lost : reported.unobservable) {
    lost.reason = kNotByMotion;
    parameters.unobservable.push_back(std::move(lost));
  }
  return parameters;
}

}  // namespace crisp::estimate
