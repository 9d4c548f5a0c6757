// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <crisp/calibration.hpp>

namespace crisp::test {

/// Largest error of any laser.
struct CalibrationErrors {
  double lambda = 0;  ///< [rad]
  double tau = 0;     ///< [m]
  double alpha = 0;   ///< [rad]
  double eta = 0;     ///< [s]
};
CalibrationErrors errors_of(const Calibration& found, const Calibration& truth);

}  // namespace crisp::test
