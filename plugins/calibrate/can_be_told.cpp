// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/calibrate/can_be_told.hpp"

#include "plugins/calibrate/observability.hpp"

namespace crisp {
namespace {

constexpr double kLeastMotion = 0.005;  // [m]
constexpr double kSpacing = 0.05;       // [s]
constexpr std::size_t kBeams = 20000;   // enough to see how points move

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

}  // namespace

FreeParameters can_be_told(FreeParameters parameters, const SensorModel& model, const Sample& sample,
                           const SearchRange& range) {
  if (parameters.free.empty()) return parameters;
  const PlateTrajectory plate = thinned(*sample.plate, kSpacing);
  Sample some = thin_evenly(sample, kBeams, 1);
  some.plate = &plate;
  const Eigen::MatrixXd motion = displacement(model, some, parameters.free) / (kLeastMotion * kLeastMotion);
  const auto told =
      observability(motion, parameters.free, model.names(), ranges_of(range, model, parameters.free));
  parameters.free = told.known;
  for (Unobservable lost : told.unobservable) {
    lost.reason = "the motion of the plate does not tell it";
    parameters.unobservable.push_back(std::move(lost));
  }
  return parameters;
}

}  // namespace crisp
