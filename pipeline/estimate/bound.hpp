// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "pipeline/estimate/sample.hpp"

namespace crisp {

struct BoundNoise {
  double range = 0.012;     ///< [m] standard deviation of a range
  double encoder_step = 0;  ///< [rad] 0: the plate's angle is known exactly; else see below
};

/// What beams can tell of the model's free parameters when the scene is not known beforehand: Fisher's
/// information for ranges with independent Gaussian noise, the planes of the scene being as unknown as the
/// parameters (three numbers each, projected out). Its inverse is the Cramér–Rao bound: no unbiased estimator
/// scatters less.
///
/// With an encoder of whole steps the plate's angle is unknown, too, to as much as the steps leave open over
/// moments of a twentieth of a second (see plate_moments()), within which a plate with mass turns smoothly.
/// That counts rounding as normal noise of the same variance: what readings tell by keeping within half a
/// step for sure is left out, so that this is what estimators by least squares can reach, and no bound for
/// others.
///
/// Beams that all but run along their surface do not count, as in no calibration.
///
/// @param truth    the model as it is
/// @param beams    n beams as they would be without noise, all of which the plate's readings cover
/// @param surface  for each beam, which of the planes it meets
/// @param normals  unit vectors, one a plane, to either side
/// @param free     m indices into truth.values()
/// @return         m × m, in the order of `free`; singular where the beams leave something open
/// @throws Error   if lengths differ, or a surface is none of the planes
Eigen::MatrixXd calibration_information(const SensorModel& truth, const Sample& beams,
                                        std::span<const std::uint32_t> surface,
                                        std::span<const Eigen::Vector3d> normals,
                                        const std::vector<std::size_t>& free, const BoundNoise& noise);

/// The least standard errors that any unbiased estimator can have: √ of the diagonal of the information's
/// inverse; infinite for what the beams do not tell.
Eigen::VectorXd least_std_errors(const Eigen::MatrixXd& information);

}  // namespace crisp
