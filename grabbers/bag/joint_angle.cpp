// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/bag/joint_angle.hpp"

#include <cmath>

#include "grabbers/bag/byte_cursor.hpp"

namespace crisp::bag {

double JointRotation::angle(const std::array<double, 4>& xyzw) {
  constexpr double kMinLength = 1e-3;
  constexpr double kMinHalfAngle = 0.0044;  // [rad] a quarter of a degree
  Eigen::Quaterniond rotation(xyzw[3], xyzw[0], xyzw[1], xyzw[2]);
  if (!rotation.coeffs().allFinite() || rotation.norm() < kMinLength)
    throw BagDamage{"rotations that are no unit quaternions"};
  rotation.normalize();
  if (!first_) first_ = rotation;
  Eigen::Quaterniond turned = first_->conjugate() * rotation;
  if (turned.w() < 0) turned.coeffs() *= -1;
  Eigen::Index largest = 0;
  turned.vec().cwiseAbs().maxCoeff(&largest);
  double sense = turned.vec()[largest] < 0 ? -1 : 1;
  const double sine = turned.vec().norm();
  if (axis_) sense = turned.vec().dot(*axis_) < 0 ? -1 : 1;
  if (!axis_ && sine > kMinHalfAngle) axis_ = sense * turned.vec() / sine;
  return sense * 2 * std::atan2(sine, turned.w());
}

}  // namespace crisp::bag
