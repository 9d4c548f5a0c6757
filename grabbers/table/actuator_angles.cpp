// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/table/actuator_angles.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <numbers>

#include <crisp/error.hpp>

namespace crisp::table {

double ActuatorAngles::unwrap(double reported) {
  constexpr double kTurn = 2 * std::numbers::pi;
  const double step = std::abs(plate_.angle_per_count());
  const double angle = std::copysign(1.0, plate_.angle_per_count()) * reported;
  const double rounded = std::round(angle / step) * step;
  last_ = last_ ? rounded + kTurn * std::round((*last_ - rounded) / kTurn) : rounded;
  return *last_;
}

void ActuatorAngles::add(double time, double angle) {
  if (!times_.empty() && time <= times_.back()) return;
  times_.push_back(time);
  angles_.push_back(angle);
}

void ActuatorAngles::forget_before(double time) {
  constexpr std::ptrdiff_t kLeft = 3;  // slopes are taken from neighbours
  const auto most = std::max<std::ptrdiff_t>(0, std::ssize(times_) - kLeft);
  const auto n = std::min(most, std::ranges::lower_bound(times_, time) - times_.begin());
  times_.erase(times_.begin(), times_.begin() + n);
  angles_.erase(angles_.begin(), angles_.begin() + n);
}

std::uint32_t ActuatorAngles::count_at(double angle) const {
  return static_cast<std::uint32_t>(static_cast<std::int64_t>(std::round(angle / plate_.angle_per_count())));
}

PlateTrajectory ActuatorAngles::trajectory(std::int64_t epoch_ns, double max_gap) const {
  if (times_.size() < 2) {
    throw Error("there are fewer than two angles of the actuator at different times",
                "check the time column of the actuator, and its unit");
  }
  return {epoch_ns, times_, angles_, max_gap};
}

}  // namespace crisp::table
