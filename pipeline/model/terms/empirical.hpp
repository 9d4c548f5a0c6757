// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>
#include <string>

#include <crisp/term.hpp>

#include "pipeline/model/rotation.hpp"
#include "pipeline/model/terms/shape.hpp"

namespace crisp {

/// Describes a departure by its shape: what is off, over what. It is the general member of a cause's family
/// where only that cause has its invariances, and else a departure that no cause of the catalogue explains.
class EmpiricalTerm final : public DifferentiableTerm<EmpiricalTerm> {
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

  template <class T>
  void change(Beam<T>& beam, std::span<const T> p) const {
    switch (over_) {
      case Over::kMirrorAngle:
        return change_by(beam.measured_mirror, beam, p);
      case Over::kPlateAngle:
        return change_by(T(beam.encoder_angle), beam, p);
      case Over::kRange:
        return change_by(beam.measured_range, beam, p);
      case Over::kIncidence:
        return change_by(incidence(beam.cos_incidence), beam, p);
      case Over::kRemission:
        return change_by(std::log(std::max(1.0, beam.remission)), beam, p);
      case Over::kTime:
        return change_by_ratio(beam.hub_time, beam, p);
      case Over::kPlateRate:
        return change_by(T(beam.plate_rate), beam, p);
      case Over::kRangePhase:
        return change_by_ratio(2 * std::numbers::pi * beam.measured_range, beam, p);
    }
  }

 private:
  /// √(−ln cos β), in which both 1/cos β and β are smooth.
  static double incidence(double cosine) {
    constexpr double kGrazing = 0.03;
    return std::sqrt(-std::log(std::clamp(std::abs(cosine), kGrazing, 1.0)));
  }

  /// By a quantity that the model does not change, relative to the last parameter. Where that is held, the
  /// ratio has no derivatives, which would take most of the time.
  template <class T>
  void change_by_ratio(double numerator, Beam<T>& beam, std::span<const T> p) const {
    if (has_derivatives(p.back()))
      change_by(T(numerator / p.back()), beam, p);
    else
      change_by(numerator / scalar(p.back()), beam, p);
  }
  static bool has_derivatives(double) { return false; }
  static bool has_derivatives(const Jet& value) { return !value.v.isZero(0); }

  template <class X, class T>
  void change_by(const X& x, Beam<T>& beam, std::span<const T> p) const {
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
        beam.origin += along_axes(weights, p);
        break;
      case On::kTilt: {
        const Vector3<T> turn = along_axes(weights, p);
        rotate(beam, Rotation<T>(turn.x(), turn.y(), turn.z()));
        break;
      }
    }
  }
  template <class X, class T>
  Vector3<T> along_axes(const ShapeWeights<X>& weights, std::span<const T> p) const {
    const std::size_t n = shape_.coefficients();
    return {sum(weights, p), sum(weights, p.subspan(n)), sum(weights, p.subspan(2 * n))};
  }

  On on_;
  Over over_;
  Shape shape_;
  TermInfo info_;
};

}  // namespace crisp
