// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <tuple>
#include <utility>

#include <crisp/term.hpp>

#include "pipeline/model/chain.hpp"

namespace crisp::model {

/// Sine and cosine of an angle, mostly a small one: then by their series, to within rounding, which takes a
/// fraction of the time.
template <class T>
std::pair<T, T> sine_and_cosine(const T& angle) {
  constexpr double kSmall = 0.02;  // [rad] whose ninth power is below the double's precision
  if (!(std::abs(scalar(angle)) < kSmall)) {
    using std::cos;
    using std::sin;
    return {sin(angle), cos(angle)};
  }
  const T square = angle * angle;
  return {angle * (1.0 + square * (-1.0 / 6 + square * (1.0 / 120 - square / 5040.0))),
          1.0 + square * (-0.5 + square * (1.0 / 24 - square / 720.0))};
}

/// The rotation Rx(x) Ry(y) Rz(z).
template <class T>
class Rotation {
 public:
  /// @param x, y, z  [rad]
  Rotation(const T& x, const T& y, const T& z) {
    std::tie(sx_, cx_) = sine_and_cosine(x);
    std::tie(sy_, cy_) = sine_and_cosine(y);
    std::tie(sz_, cz_) = sine_and_cosine(z);
  }
  template <class V>
  Vector3<V> operator()(const Vector3<V>& v) const {
    const V x = cz_ * v.x() - sz_ * v.y();
    const V y = sz_ * v.x() + cz_ * v.y();
    const V z = cy_ * v.z() - sy_ * x;
    return {cy_ * x + sy_ * v.z(), cx_ * y - sx_ * z, sx_ * y + cx_ * z};
  }

 private:
  T cx_, sx_, cy_, sy_, cz_, sz_;
};

/// Rotates a beam, its origin and its direction, about the origin of the frame.
///
/// @param rotation  by numbers, or by angles with derivatives
template <class T, class A>
void rotate(Beam<T>& beam, const Rotation<A>& rotation) {
  beam.origin = rotation(beam.origin);
  beam.direction = rotation(beam.direction);
}

}  // namespace crisp::model
