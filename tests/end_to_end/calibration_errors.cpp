// SPDX-License-Identifier: BSD-3-Clause
#include "tests/end_to_end/calibration_errors.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace crisp::test {

CalibrationErrors errors_of(const Calibration& found, const Calibration& truth) {
  CalibrationErrors errors;
  for (std::size_t i = 0; i < truth.lasers.size(); ++i) {
    const LaserCalibration& is = found.lasers.at(i);
    const LaserCalibration& was = truth.lasers[i];
    const double turn = std::remainder(is.lambda.value - was.lambda.value, 2 * std::numbers::pi);
    errors.lambda = std::max(errors.lambda, std::abs(turn));
    errors.tau = std::max(errors.tau, std::abs(is.tau.value - was.tau.value));
    errors.alpha = std::max(errors.alpha, std::abs(is.alpha.value - was.alpha.value));
    errors.eta = std::max(errors.eta, std::abs(is.eta.value - was.eta.value));
  }
  return errors;
}

}  // namespace crisp::test
