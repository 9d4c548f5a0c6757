// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "pipeline/model/chain.hpp"
#include "pipeline/model/term.hpp"

namespace crisp {

/// A function of one number with n coefficients, in which it is linear.
class Shape {
 public:
  /// Σ aₖ cos kx + bₖ sin kx for the orders from `first` to `last`.
  static Shape fourier(int first, int last);
  /// Piecewise linear between knots (ascending), with the coefficients as values; constant beyond them.
  static Shape hats(std::vector<double> knots);
  /// A smooth function for x from 0 to 1: n ≥ 4 cubic B-splines at even distances. Level beyond.
  static Shape splines(int n);
  /// a x² + b x abs(x) + c x³
  static Shape powers();
  /// a x² + b x³: what bends, for x that is never negative.
  static Shape curve();

  std::size_t coefficients() const;
  double scale() const;  ///< by how much smaller coefficients are than what they make
  std::string name(std::size_t coefficient) const;     ///< "cos2"
  std::string summary(std::size_t coefficient) const;  ///< "of cos 2x"
  /// The same as the finer of two over one covariate.
  Shape finely() const {
    Shape fine = *this;
    fine.is_fine_ = true;
    return fine;
  }
  bool is_fine() const { return is_fine_; }
  /// Suffix of this shape's name next to the usual one over the same covariate: "_curve"; or nothing.
  std::string suffix() const { return kind_ == Kind::kCurve ? "_curve" : is_fine_ ? "_finely" : ""; }

  template <class T>
  T at(const T& x, std::span<const T> coefficients) const {
    switch (kind_) {
      case Kind::kFourier:
        return fourier_at(x, coefficients);
      case Kind::kHats:
        return hats_at(x, coefficients);
      case Kind::kSplines:
        return splines_at(x, coefficients);
      case Kind::kPowers:
        return coefficients[0] * (x * x) + coefficients[1] * (x * abs_of(x)) + coefficients[2] * (x * x * x);
      case Kind::kCurve:
        return (coefficients[0] + coefficients[1] * x) * (x * x);
    }
    return T(0);
  }

 private:
  enum class Kind { kFourier, kHats, kSplines, kPowers, kCurve };
  Shape(Kind kind, int first, int last, std::vector<double> knots)
      : kind_(kind), first_(first), last_(last), knots_(std::move(knots)) {}

  template <class T>
  static T abs_of(const T& x) {
    return scalar(x) < 0 ? T(-x) : x;
  }
  template <class T>
  T fourier_at(const T& x, std::span<const T> coefficients) const {
    using std::cos;
    using std::sin;
    T sum(0);
    for (int order = first_; order <= last_; ++order) {
      const auto k = 2 * static_cast<std::size_t>(order - first_);
      const T turned = static_cast<double>(order) * x;
      sum += coefficients[k] * cos(turned) + coefficients[k + 1] * sin(turned);
    }
    return sum;
  }
  template <class T>
  T hats_at(const T& x, std::span<const T> coefficients) const {
    const auto above = std::ranges::upper_bound(knots_, scalar(x));
    if (above == knots_.begin()) return coefficients.front();
    if (above == knots_.end()) return coefficients.back();
    const auto k = static_cast<std::size_t>(above - knots_.begin());
    const T share = (x - knots_[k - 1]) / (knots_[k] - knots_[k - 1]);
    return coefficients[k - 1] * (1.0 - share) + coefficients[k] * share;
  }
  template <class T>
  T splines_at(const T& x, std::span<const T> coefficients) const {
    const double pieces = last_ - 3;
    const T inside = scalar(x) < 0 ? T(0) : scalar(x) > 1 ? T(1) : x;
    const double piece = std::min(std::floor(scalar(inside) * pieces), pieces - 1);
    const T t = inside * pieces - piece;
    const T s = 1.0 - t;
    const auto c = coefficients.subspan(static_cast<std::size_t>(piece), 4);
    return (c[0] * (s * s * s) + c[1] * (4.0 - 6.0 * t * t + 3.0 * t * t * t) +
            c[2] * (4.0 - 6.0 * s * s + 3.0 * s * s * s) + c[3] * (t * t * t)) /
           6.0;
  }

  Kind kind_;
  int first_;  // order
  int last_;   // order, or how many B-splines
  std::vector<double> knots_;
  bool is_fine_ = false;
};

/// Describes a departure that no cause of the catalogue explains: what is off, over what, and in which shape.
class EmpiricalTerm final : public DifferentiableTerm<EmpiricalTerm> {
 public:
  enum class On { kRange, kMirrorAngle, kElevation, kPlateAngle, kLag, kBase };
  enum class Over { kMirrorAngle, kPlateAngle, kRange, kIncidence, kRemission, kTime, kPlateRate };

  EmpiricalTerm(On on, Over over, Shape shape);
  const TermInfo& info() const override { return info_; }

  template <class T>
  void change(Beam<T>& beam, std::span<const T> p) const {
    const T x = covariate(beam, p);
    const std::size_t n = shape_.coefficients();
    switch (on_) {
      case On::kRange:
        beam.range += shape_.at(x, p.first(n));
        break;
      case On::kMirrorAngle:
        beam.mirror_angle += shape_.at(x, p.first(n));
        break;
      case On::kElevation:
        beam.direction.z() += shape_.at(x, p.first(n));
        beam.direction.normalize();
        break;
      case On::kPlateAngle:
        beam.plate_angle += shape_.at(x, p.first(n));
        break;
      case On::kLag:
        beam.time += shape_.at(x, p.first(n));
        break;
      case On::kBase:
        for (std::size_t axis = 0; axis < 3; ++axis) {
          beam.origin[static_cast<Eigen::Index>(axis)] += shape_.at(x, p.subspan(axis * n, n));
        }
        break;
    }
  }

 private:
  template <class T>
  T covariate(const Beam<T>& beam, std::span<const T> p) const {
    switch (over_) {
      case Over::kMirrorAngle:
        return T(beam.measured_mirror);
      case Over::kPlateAngle:
        return beam.encoder_angle;
      case Over::kRange:
        return T(beam.measured_range);
      case Over::kIncidence:
        return T(std::acos(std::clamp(std::abs(beam.cos_incidence), 0.0, 1.0)));
      case Over::kRemission:
        return T(std::log(std::max(1.0, beam.remission)));
      case Over::kTime:
        return beam.hub_time / p.back();
      case Over::kPlateRate:
        return beam.plate_rate;
    }
    return T(0);
  }

  On on_;
  Over over_;
  Shape shape_;
  TermInfo info_;
};

}  // namespace crisp
