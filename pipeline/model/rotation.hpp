// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>

#include <crisp/beam.hpp>

namespace crisp {

/// The rotation Rx(x) Ry(y) Rz(z).
template <class T>
class Rotation {
 public:
  /// @param x, y, z  [rad]
  Rotation(const T& x, const T& y, const T& z) {
    using std::cos;
    using std::sin;
    cx_ = cos(x), sx_ = sin(x);
    cy_ = cos(y), sy_ = sin(y);
    cz_ = cos(z), sz_ = sin(z);
  }
  Vector3<T> operator()(const Vector3<T>& v) const {
    const T x = cz_ * v.x() - sz_ * v.y();
    const T y = sz_ * v.x() + cz_ * v.y();
    const T z = cy_ * v.z() - sy_ * x;
    return {cy_ * x + sy_ * v.z(), cx_ * y - sx_ * z, sx_ * y + cx_ * z};
  }

 private:
  T cx_, sx_, cy_, sy_, cz_, sz_;
};

/// Rotates a beam, its origin and its direction, about the origin of the frame.
template <class T>
void rotate(Beam<T>& beam, const Rotation<T>& rotation) {
  beam.origin = rotation(beam.origin);
  beam.direction = rotation(beam.direction);
}

}  // namespace crisp
