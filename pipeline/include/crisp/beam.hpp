// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ceres/jet.h>

#include <Eigen/Core>
#include <cstdint>

namespace crisp {

/// A number with its derivatives with respect to up to eight parameters.
using Jet = ceres::Jet<double, 8>;

template <class T>
using Vector3 = Eigen::Matrix<T, 3, 1>;

/// One beam on its way through the chain of the sensor model. T is double or Jet; measurements of the device
/// and the encoder are plain double, quantities of the model are T. Each phase of the chain may read all that
/// earlier phases have set:
///
/// | phase  | sets                | frame                                                            |
/// |--------|---------------------|------------------------------------------------------------------|
/// | time   | time                | the plate's clock                                                |
/// | plate  | plate_angle         | the encoder reading is kept in encoder_angle                     |
/// | mirror | mirror_angle        |                                                                  |
/// | beam   | origin, direction   | the laser's: the scan plane is z = 0, θ = 0 along +x             |
/// | mount  | origin, direction   | the plate's, before the turn by φ + λ: x outwards, z = spin axis |
/// | base   | origin, direction   | the base's: z = spin axis                                        |
/// | range  | range               |                                                                  |
///
/// The point is origin + range * direction. A term that corrects a reading computes the correction from the
/// reading itself (hub_time, encoder_angle, measured_mirror, measured_range), not from what other terms have
/// made of it, so that their order does not matter.
template <class T>
struct Beam {
  double measured_range = 0;   ///< [m]
  double measured_mirror = 0;  ///< [rad] θ
  double hub_time = 0;         ///< [s since the run's epoch]
  double remission = 0;        ///< device's units
  double cos_incidence = 1;    ///< cos β on the surface that was met; 1 where nobody knows it
  std::uint16_t number = 0;    ///< index in its scan

  T time{};                                   ///< [s since the run's epoch] hub_time + η
  T encoder_angle{};                          ///< [rad] φ at `time` as the encoder reads it
  T plate_rate{};                             ///< [rad/s] its derivative
  T plate_direction{};                        ///< PlateState::direction at `time`
  T plate_angle{};                            ///< [rad] φ at `time`
  T mirror_angle{};                           ///< [rad] θ
  Vector3<T> origin = Vector3<T>::Zero();     ///< [m]
  Vector3<T> direction = Vector3<T>::Zero();  ///< unit vector
  T range{};                                  ///< [m]

  /// The measured point [m], in the frame that origin and direction are in.
  Vector3<T> point() const { return origin + direction * range; }
};

}  // namespace crisp
