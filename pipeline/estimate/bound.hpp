// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "pipeline/estimate/sample.hpp"

namespace crisp::estimate {

struct BoundNoise {
  double range = 0.012;     ///< [m] standard deviation of a range
  double encoder_step = 0;  ///< [rad] 0: the plate's angle is known exactly; else see below
};

/// Cramér–Rao bound of the model's free parameters for an unknown scene: Fisher's information for ranges with
/// independent Gaussian noise, the planes of the scene being unknown as well (three parameters each,
/// projected out). Its inverse is a lower bound for the covariance of unbiased estimators.
///
/// With an encoder of whole steps the plate's angle is unknown, too, within the rounding of the steps over
/// moments of a twentieth of a second (see encoder_error_blocks()), within which a plate with mass turns
/// smoothly. Rounding counts as normal noise of the same variance; the information of the hard limits of half
/// a step is left out. So this is the bound for estimators by least squares, and not for others.
///
/// Beams that all but run along their surface do not count, as in calibration.
///
/// @param truth    the model as it is
/// @param beams    n beams as they would be without noise, all of them covered by encoder readings
/// @param surface  for each beam, which of the planes it meets
/// @param normals  unit vectors, one a plane, to either side
/// @param free     m indices into truth.values()
/// @return         m × m, in the order of `free`; singular where parameters are unidentifiable
/// @throws Error   if lengths differ, or a surface is none of the planes
Eigen::MatrixXd calibration_information(const SensorModel& truth, const Sample& beams,
                                        std::span<const std::uint32_t> surface,
                                        std::span<const Eigen::Vector3d> normals,
                                        const std::vector<std::size_t>& free, const BoundNoise& noise);

/// The least standard errors of any unbiased estimator: √ of the diagonal of the information's inverse;
/// infinite for unidentifiable parameters.
Eigen::VectorXd least_std_errors(const Eigen::MatrixXd& information);

}  // namespace crisp::estimate
