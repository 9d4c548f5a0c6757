// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cmath>

#include <crisp/term.hpp>

namespace crisp::model {

/// Pose of one laser on the plate, for equation (2) of Sheehan, Harrison and Newman.
template <class T>
struct Mounting {
  T lambda{};  ///< [rad] λ
  T tau{};     ///< [m] τ
  T alpha{};   ///< [rad] α
};

/// The beam in the scan plane: (cos θ, sin θ, 0) from the laser's origin.
template <class T>
void aim(Beam<T>& beam) {
  using std::cos;
  using std::sin;
  beam.origin.setZero();
  beam.direction = {cos(beam.mirror_angle), sin(beam.mirror_angle), T(0)};
}

/// From the laser's frame to the plate's: Tx(τ) Rz(α) Ry(π/2). Ry(π/2) takes (x, y, z) to (z, y, −x).
template <class T>
void mount(Beam<T>& beam, const Mounting<T>& laser) {
  using std::cos;
  using std::sin;
  const T c = cos(laser.alpha);
  const T s = sin(laser.alpha);
  const auto turn = [&](const Vector3<T>& v) {
    return Vector3<T>(c * v.z() - s * v.y(), s * v.z() + c * v.y(), -v.x());
  };
  beam.origin = turn(beam.origin);
  beam.origin.x() += laser.tau;
  beam.direction = turn(beam.direction);
}

/// From the plate's frame to the base's: Rz(φ + λ).
template <class T>
void spin(Beam<T>& beam, const T& azimuth) {
  using std::cos;
  using std::sin;
  const T c = cos(azimuth);
  const T s = sin(azimuth);
  const auto turn = [&](const Vector3<T>& v) {
    return Vector3<T>(c * v.x() - s * v.y(), s * v.x() + c * v.y(), v.z());
  };
  beam.origin = turn(beam.origin);
  beam.direction = turn(beam.direction);
}

}  // namespace crisp::model
