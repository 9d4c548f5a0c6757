// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>

#include <crisp/plate_trajectory.hpp>

// Plain data only: what is behind is compiled once for each kind of processor.
namespace crisp::simd {

/// Number of elements by which the points' arrays must be writable beyond the last beam.
inline constexpr std::size_t kBeyond = 8;

/// Measurements of one laser.
struct BareBeams {
  const float* range;         ///< [m]
  const float* mirror;        ///< [rad] θ
  const double* time;         ///< [s since the epoch] hub time
  const std::uint16_t* beam;  ///< index of the beam in its scan
  std::size_t size;
};

/// Mirror angles of one laser, by the index of the beam, with their sines and cosines: those met last.
struct MirrorTable {
  float* angle;  ///< [rad] θ; no number: none was met yet
  double* sine;
  double* cosine;
  std::size_t size;
};

/// The parameters of equation (2), as the chain of one laser without terms takes them.
struct BareLaser {
  double lambda;     ///< [rad] λ
  double tau;        ///< [m] τ
  double cos_alpha;  ///< of α
  double sin_alpha;
  double eta;  ///< [s] η
};

/// Equation (2) with (3) for the leading beams that were fired while the plate went along `arc`: what trace()
/// in chain.hpp makes of them, to rounding.
/// @param mirrors  where an angle is still what it was there, its sine and cosine are taken; others are put
/// in
/// @return how many beams these are: from the next on, x, y and z hold nothing
std::size_t place_bare(const BareBeams& beams, const BareLaser& laser, const PlateArc& arc,
                       const MirrorTable& mirrors, double* x, double* y, double* z);

/// Measurements of any lasers, each with its laser's parameters.
/// All arrays are readable, and those of MixedPoints writable, kBeyond elements beyond the last beam; what
/// `interval` holds there must be of the plate, too.
struct MixedArrays {
  const float* range;            ///< [m]
  const float* mirror;           ///< [rad] θ
  const double* time;            ///< [s since the epoch] on the plate's clock
  const std::int64_t* interval;  ///< the plate's reading with which the beam's arc begins
  const double* lambda;          ///< [rad] λ
  const double* tau;             ///< [m] τ
  const double* cos_alpha;
  const double* sin_alpha;
  std::size_t size;
};

/// Encoder readings of a PlateTrajectory.
struct PlateReadings {
  const double* times;   ///< [s since the epoch]
  const double* angles;  ///< [rad]
  const double* rates;   ///< [rad/s]
};

struct MixedPoints {
  double* x;       ///< [m]
  double* y;       ///< [m]
  double* z;       ///< [m]
  double* cosine;  ///< of φ + λ
  double* sine;
  double* rate;  ///< [rad/s] of the plate
};

/// Equation (2) with (3) for each beam: to the last bit what place_bare() gives.
void place_mixed(const MixedArrays& beams, const PlateReadings& plate, const MixedPoints& points);

/// Sine and cosine of n angles [rad], those inside, for the tests.
void sine_cosine(const double* angle, std::size_t n, double* sine, double* cosine);

}  // namespace crisp::simd
