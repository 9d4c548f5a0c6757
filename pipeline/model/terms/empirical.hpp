// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>
#include <string>
#include <type_traits>

#include <crisp/term.hpp>

#include "pipeline/model/rotation.hpp"
#include "pipeline/model/terms/shape.hpp"

namespace crisp::model {

/// Describes a departure by its shape: what is off, over what. It is the general member of a cause's family
/// where only that cause has its invariances, and else a departure that no cause of the catalogue explains.
class EmpiricalTerm final : public ModelTerm {
 public:
  enum class On { kRange, kMirrorAngle, kElevation, kPlateAngle, kLag, kBase, kTilt };
  enum class Over {
    kMirrorAngle,
    kPlateAngle,
    kRange,
    kIncidence,
    kRemission,
    kTime,
    kPlateRate,
    kRangePhase
  };

  /// @param family  cause whose general member this is; empty: none
  EmpiricalTerm(On on, Over over, Shape shape, std::string family = {});
  const TermInfo& info() const override { return info_; }

  void apply(std::span<Beam<double>> beams, std::span<const double> parameters) const override;
  /// Of a chain's many parameters eight have derivatives in one pass. Where none of this term's has, its
  /// coefficients are numbers, which takes a fraction of the time.
  void apply(std::span<Beam<Jet>> beams, std::span<const Jet> parameters) const override;

 private:
  /// √(−ln cos β), in which both 1/cos β and β are smooth.
  static double incidence(double cosine) {
    constexpr double kGrazing = 0.03;
    return std::sqrt(-std::log(std::clamp(std::abs(cosine), kGrazing, 1.0)));
  }

  /// @param p  P is double, or T
  template <class T, class P>
  void change(Beam<T>& beam, std::span<const P> p) const {
    switch (over_) {
      case Over::kMirrorAngle:
        return change_by(beam.measured_mirror, beam, p);
      case Over::kPlateAngle:
        return change_over(T(beam.encoder_angle), beam, p);
      case Over::kRange:
        return change_by(beam.measured_range, beam, p);
      case Over::kIncidence:
        return change_by(incidence(beam.cos_incidence), beam, p);
      case Over::kRemission:
        return change_by(std::log(std::max(1.0, beam.remission)), beam, p);
      case Over::kTime:
        return change_over(beam.hub_time / p.back(), beam, p);
      case Over::kPlateRate:
        return change_over(T(beam.plate_rate), beam, p);
      case Over::kRangePhase:
        return change_over((2 * std::numbers::pi * beam.measured_range) / p.back(), beam, p);
    }
  }

  /// By numbers where nothing moves x, which takes a fraction of the time.
  template <class X, class T, class P>
  void change_over(const X& x, Beam<T>& beam, std::span<const P> p) const {
    if constexpr (std::is_same_v<X, Jet>) {
      if (x.v.isZero(0)) return change_by(x.a, beam, p);
    }
    change_by(x, beam, p);
  }

  template <class X, class T, class P>
  void change_by(const X& x, Beam<T>& beam, std::span<const P> p) const {
    const auto weights = shape_.weights(x);
    const auto shape = [&] { return sum(weights, p); };
    switch (on_) {
      case On::kRange:
        beam.range += shape();
        break;
      case On::kMirrorAngle:
        beam.mirror_angle += shape();
        break;
      case On::kElevation:
        beam.direction.z() += shape();
        beam.direction.normalize();
        break;
      case On::kPlateAngle:
        beam.plate_angle += shape();
        break;
      case On::kLag:
        beam.time += shape();
        break;
      case On::kBase:
        beam.origin += along_axes(weights, p).template cast<T>();
        break;
      case On::kTilt: {
        const auto turn = along_axes(weights, p);
        rotate(beam, Rotation(turn.x(), turn.y(), turn.z()));
        break;
      }
    }
  }
  template <class X, class P>
  auto along_axes(const ShapeWeights<X>& weights, std::span<const P> p) const {
    using Number = decltype(X() * P());
    const std::size_t n = shape_.coefficients();
    const bool has_z = p.size() >= 3 * n;
    return Vector3<Number>{sum(weights, p), sum(weights, p.subspan(n)),
                           has_z ? sum(weights, p.subspan(2 * n)) : Number(0)};
  }

  On on_;
  Over over_;
  Shape shape_;
  TermInfo info_;
};

}  // namespace crisp::model
