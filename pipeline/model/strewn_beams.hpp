// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <span>
#include <vector>

#include "pipeline/data/measurements.hpp"
#include "pipeline/data/plate_trajectory.hpp"
#include "pipeline/model/bare_chain.hpp"

namespace crisp {

/// A block of beams that lie anyhow over time and lasers, as those of a sample do, to be placed together by
/// equation (2) alone: the plate is asked for each beam, and the rest is done by vectors over beams.
class StrewnBeams {
 public:
  static constexpr std::size_t kCapacity = 256;

  /// @param lasers  must outlive this, as must the plate
  StrewnBeams(std::span<const simd::BareLaser> lasers, const PlateTrajectory& plate);

  /// Adds measurement i of `beams`, of a laser that is among those given, unless the plate's readings do not
  /// cover it.
  void add(const Measurements& beams, std::size_t i);
  bool full() const { return index_.size() == kCapacity; }
  std::size_t size() const { return index_.size(); }
  void clear() { index_.clear(); }

  /// Places all that were added.
  void place();

  // What holds of beam k after place():
  std::uint32_t index(std::size_t k) const { return index_[k]; }  ///< of the measurement
  double x(std::size_t k) const { return points_[kX][k]; }        ///< [m]
  double y(std::size_t k) const { return points_[kY][k]; }        ///< [m]
  double z(std::size_t k) const { return points_[kZ][k]; }        ///< [m]

  /// ∂(x, y) by λ, τ, α and η; z depends on none of them.
  std::array<std::array<double, 2>, 4> slopes(std::size_t k) const {
    const double cosine = points_[kCosine][k];
    const double sine = points_[kSine][k];
    const double rate = points_[kRate][k];
    const double tau = beams_[kTau][k];
    return {{{-y(k), x(k)},
             {cosine, sine},
             {tau * sine - y(k), x(k) - tau * cosine},
             {-rate * y(k), rate * x(k)}}};
  }

 private:
  enum Field {
    kTime,
    kBegin,
    kInverse,
    kCoefficients,
    kLambda = kCoefficients + 4,
    kTau,
    kCosAlpha,
    kSinAlpha,
    kFields
  };
  enum PointField { kX, kY, kZ, kCosine, kSine, kRate, kPointFields };
  static constexpr std::size_t kSize = kCapacity + simd::kBeyond;

  std::span<const simd::BareLaser> lasers_;
  const PlateTrajectory& plate_;
  std::vector<PlateTrajectory::Cursor>
      plates_;  // one a laser, once there is a beam: each has times of its own
  std::vector<std::uint32_t> index_;
  std::vector<float> range_;
  std::vector<float> mirror_;
  std::vector<std::array<double, kSize>> beams_;   // by Field
  std::vector<std::array<double, kSize>> points_;  // by PointField
};

}  // namespace crisp
