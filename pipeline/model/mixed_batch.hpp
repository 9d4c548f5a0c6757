// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include <crisp/measurements.hpp>
#include <crisp/plate_trajectory.hpp>

#include "pipeline/model/simd_placement.hpp"

namespace crisp::model {

/// A batch of beams of mixed times and lasers, placed together by equation (2) alone: the plate is queried
/// for each beam, and the rest is vectorized over beams.
class MixedBeams {
 public:
  static constexpr std::size_t kCapacity = 256;

  /// @param lasers  must outlive this, as must the plate
  MixedBeams(std::span<const simd::BareLaser> lasers, const PlateTrajectory& plate);

  /// Adds the measurements begin … end − 1 of `beams`, of lasers that are among those given, but those that
  /// the encoder readings do not cover. There must be room for all.
  void add(const Measurements& beams, std::size_t begin, std::size_t end);
  std::size_t room() const { return kCapacity - size_; }
  std::size_t size() const { return size_; }
  void clear() { size_ = 0; }

  /// Places all that were added.
  void place();

  // Results for beam k after place():
  std::uint32_t index(std::size_t k) const { return index_[k]; }  ///< of the measurement
  double x(std::size_t k) const { return points_[kX][k]; }        ///< [m]
  double y(std::size_t k) const { return points_[kY][k]; }        ///< [m]
  double z(std::size_t k) const { return points_[kZ][k]; }        ///< [m]

  // And of the beams k … end − 1:
  std::span<const double> x(std::size_t k, std::size_t end) const { return {&points_[kX][k], end - k}; }
  std::span<const double> y(std::size_t k, std::size_t end) const { return {&points_[kY][k], end - k}; }
  std::span<const double> z(std::size_t k, std::size_t end) const { return {&points_[kZ][k], end - k}; }

  /// The end of those beams from k on whose measurements follow one another.
  std::size_t consecutive_end(std::size_t k) const {
    std::size_t end = k + 1;
    while (end < size_ && index_[end] == index_[end - 1] + 1) ++end;
    return end;
  }

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
  enum Field { kTime, kLambda, kTau, kCosAlpha, kSinAlpha, kFields };
  enum PointField { kX, kY, kZ, kCosine, kSine, kRate, kPointFields };
  static constexpr std::size_t kSize = kCapacity + simd::kBeyond;

  std::span<const simd::BareLaser> lasers_;
  const PlateTrajectory& plate_;
  std::size_t size_ = 0;
  // Not cleared: only the added entries are used, but for the intervals, which must be valid ones of the
  // plate.
  std::uint32_t index_[kCapacity];
  std::array<std::int64_t, kSize> interval_{};
  float range_[kSize];
  float mirror_[kSize];
  double beams_[kFields][kSize];
  double points_[kPointFields][kSize];
};

}  // namespace crisp::model
