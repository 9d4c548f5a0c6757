// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <crisp/sensor_model.hpp>

#include "pipeline/data/degree.hpp"

namespace crisp {

/// One laser with the given mounting.
inline Calibration one_laser(double lambda, double tau, double alpha, double eta = 0) {
  Calibration calibration;
  LaserCalibration& laser = calibration.lasers.emplace_back();
  laser.name = "laser1";
  laser.lambda.value = lambda;
  laser.tau.value = tau;
  laser.alpha.value = alpha;
  laser.eta.value = eta;
  return calibration;
}

/// Two lasers of which no parameter is zero.
inline Calibration two_lasers() {
  Calibration calibration = one_laser(0.1, 0.2, -0.03, 0.004);
  calibration.lasers.push_back(one_laser(2.2, 0.18, 0.05, -0.01).lasers.front());
  calibration.lasers.back().name = "laser2";
  return calibration;
}

/// Ranges and mirror angles are floats.
inline constexpr double kFloat = 1e-6;  // [m]

/// One beam of laser 0, fired at t = 1 s.
inline Measurements one_beam(double range, double mirror) {
  return {.range = {static_cast<float>(range)},
          .mirror_angle = {static_cast<float>(mirror)},
          .time = {1.0},
          .laser = {0},
          .remission = {0},
          .beam = {0}};
}

/// A plate that stands at `angle` at t = 1 s and turns with `rate` [rad/s].
inline PlateTrajectory turning_plate(double angle, double rate = 0) {
  return {0,
          {0.0, 0.5, 1.0, 1.5, 2.0},
          {angle - rate, angle - rate / 2, angle, angle + rate / 2, angle + rate},
          1.0};
}

}  // namespace crisp
