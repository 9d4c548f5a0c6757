// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include <crisp/rig.hpp>
#include <crisp/sensor_model.hpp>

namespace crisp::estimate {

/// Result of a calibration: values with their covariance.
struct Outcome {
  SensorModel model;              ///< at the values that were found
  std::vector<std::size_t> free;  ///< indices into model.values(): m parameters that were turned
  Eigen::MatrixXd covariance;     ///< m × m, of these, in their order
  std::vector<Unobservable> unobservable;
  std::vector<std::string> caveats = {};  ///< why this may not be the truth, in words
  std::vector<std::string> other_minima =
      {};  ///< competing values that this method does not distinguish from these, in words
  std::vector<std::size_t> not_estimated =
      {};  ///< parameters that this method cannot find, though another may
};

/// The outcome as a calibration: values, standard errors, covariance, and what is unobservable. Each λ and α
/// is given within half a turn of the rig's.
Calibration calibration_of(const Outcome& outcome, const Rig& rig);

/// The calibration with each λ and α within half a turn of the rig's.
Calibration with_angles_near(Calibration calibration, const Rig& rig);

/// A table for people: each parameter in mm, degrees and ms, its standard error and its change from the
/// rig's nominal value.
std::string table_of(const Calibration& calibration, const Rig& rig);

}  // namespace crisp::estimate
