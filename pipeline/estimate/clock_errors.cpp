// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/estimate/clock_errors.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace crisp::estimate {
namespace {

const ClockMap* clock_of(const std::string& device, const std::map<std::string, ClockMap>& clocks) {
  const auto found = clocks.find(device);
  return found == clocks.end() ? nullptr : &found->second;
}

/// [s] Standard deviation of a device's times about their mean over a recording.
double spread_of(const std::string& device, const std::map<std::string, ClockMap>& clocks, double duration) {
  constexpr double kEven = 12;  // variance of a whole, evenly spread, is a twelfth
  const ClockMap* clock = clock_of(device, clocks);
  return clock ? clock->skew_std_error * duration / std::sqrt(kEven) : 0;
}

double rms_rate(const PlateTrajectory& plate) {
  double squares = 0;
  for (const double rate : plate.rates()) squares += rate * rate;
  return std::sqrt(squares / static_cast<double>(std::max<std::size_t>(1, plate.size())));
}

}  // namespace

void add_clock_errors(Outcome& outcome, const Rig& rig, const std::map<std::string, ClockMap>& clocks) {
  const auto variance_of = [&](const std::string& device) {
    const ClockMap* clock = clock_of(device, clocks);
    return clock ? clock->std_error * clock->std_error : 0;
  };
  const auto laser_of = [&](std::size_t parameter) -> std::optional<std::string> {
    const std::string& name = outcome.model.names()[parameter];
    if (!name.ends_with(".eta")) return std::nullopt;
    return name.substr(0, name.rfind('.'));
  };
  const double of_plate = variance_of(rig.plate.name);
  for (std::size_t i = 0; i < outcome.free.size(); ++i) {
    const auto laser = laser_of(outcome.free[i]);
    if (!laser) continue;
    for (std::size_t j = 0; j < outcome.free.size(); ++j) {
      if (!laser_of(outcome.free[j])) continue;
      outcome.covariance(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) +=
          of_plate + (i == j ? variance_of(*laser) : 0);
    }
  }
}

double plate_angle_error(const PlateTrajectory& plate, const Rig& rig,
                         const std::map<std::string, ClockMap>& clocks) {
  if (plate.empty()) return 0;
  const double duration = plate.end() - plate.begin();
  double of_lasers = 0;
  for (const RigLaser& laser : rig.lasers) {
    of_lasers = std::max(of_lasers, spread_of(laser.name, clocks, duration));
  }
  const double time = std::hypot(of_lasers, spread_of(rig.plate.name, clocks, duration));
  const double step = std::abs(rig.plate.angle_per_count()) / std::sqrt(12);
  return std::hypot(step, rms_rate(plate) * time);
}

}  // namespace crisp::estimate
