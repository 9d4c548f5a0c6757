// SPDX-License-Identifier: BSD-3-Clause
#include <numbers>

#include <crisp/rig.hpp>

#include "pipeline/data/degree.hpp"

namespace crisp {

double RigPlate::angle_per_count() const {
  const double step = 2 * std::numbers::pi / counts_per_revolution;
  return direction == CountDirection::clockwise ? -step : step;
}

Calibration nominal_calibration(const Rig& rig) {
  Calibration calibration;
  for (const auto& laser : rig.lasers) {
    calibration.lasers.push_back(laser.nominal);
    calibration.lasers.back().name = laser.name;
  }
  if (rig.plate.direction == CountDirection::clockwise) calibration.direction = CountDirection::clockwise;
  return calibration;
}

Rig default_rig() {
  Rig rig;
  for (int i = 0; i < 3; ++i) {
    RigLaser laser;
    laser.name = "laser" + std::to_string(i + 1);
    laser.address = {.ip = "192.168.0." + std::to_string(i + 1), .port = 0};
    laser.mount = 45 * data::kDegree;
    laser.nominal.name = laser.name;
    laser.nominal.tau.value = 0.20;
    laser.nominal.lambda.value = i * 120 * data::kDegree;
    rig.lasers.push_back(laser);
  }
  rig.plate.address = {.ip = "192.168.0.10", .port = 4000};
  return rig;
}

}  // namespace crisp
