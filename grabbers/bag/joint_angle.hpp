// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <optional>

namespace crisp::bag {

/// The angle of a revolute joint from its rotations, as tf and poses give them: about the joint's axis,
/// counted from the first rotation, so that a constant rotation before the joint does not matter.
///
/// The axis is that of the first rotation by more than half a degree, in the sense in which its largest
/// component is positive.
class JointRotation {
 public:
  /// @param xyzw  a quaternion of any length but 0
  /// @return [rad] −π to π
  /// @throws BagDamage if the quaternion is none
  double angle(const std::array<double, 4>& xyzw);

 private:
  std::optional<Eigen::Quaterniond> first_;
  std::optional<Eigen::Vector3d> axis_;
};

}  // namespace crisp::bag
