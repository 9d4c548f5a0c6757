// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "pipeline/model/chain.hpp"
#include "pipeline/model/rotation.hpp"
#include "pipeline/model/term.hpp"

namespace crisp {

/// A function of one number with n coefficients, in which it is linear.
class Shape {
 public:
  /// Σ aₖ cos kx + bₖ sin kx for the orders from `first` to `last`.
  static Shape fourier(int first, int last);
  /// Piecewise linear between knots (ascending), with the coefficients as values; constant beyond them.
  static Shape hats(std::vector<double> knots);
  /// A smooth function for x between two ends, 0 at `zero`: n + 1 ≥ 4 cubic B-splines at even distances, less
  /// their sum at `zero`. The coefficient of the B-spline nearest to `zero` is 0, since what all of them
  /// share cancels. Level beyond both ends.
  static Shape splines(int n, double from, double to, double zero);
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

  /// @param x  X is double for a covariate that the model does not change, or T
  template <class X, class T>
  T at(const X& x, std::span<const T> coefficients) const {
    switch (kind_) {
      case Kind::kFourier:
        return fourier_at(x, coefficients);
      case Kind::kHats:
        return hats_at(x, coefficients);
      case Kind::kSplines:
        return sum_of_splines(x, coefficients) - sum_of_splines(knots_[2], coefficients);
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

  template <class X>
  static X abs_of(const X& x) {
    return scalar(x) < 0 ? X(-x) : x;
  }
  template <class X, class T>
  T fourier_at(const X& x, std::span<const T> coefficients) const {
    using std::cos;
    using std::sin;
    T sum(0);
    for (int order = first_; order <= last_; ++order) {
      const auto k = 2 * static_cast<std::size_t>(order - first_);
      const X turned = static_cast<double>(order) * x;
      sum += coefficients[k] * cos(turned) + coefficients[k + 1] * sin(turned);
    }
    return sum;
  }
  template <class X, class T>
  T hats_at(const X& x, std::span<const T> coefficients) const {
    const auto above = std::ranges::upper_bound(knots_, scalar(x));
    if (above == knots_.begin()) return coefficients.front();
    if (above == knots_.end()) return coefficients.back();
    const auto k = static_cast<std::size_t>(above - knots_.begin());
    const X share = (x - knots_[k - 1]) / (knots_[k] - knots_[k - 1]);
    return coefficients[k - 1] * (1.0 - share) + coefficients[k] * share;
  }
  /// The four B-splines at x, and the first of them.
  template <class X>
  std::pair<std::array<X, 4>, std::size_t> splines_about(const X& x) const {
    const double pieces = last_ - 3;
    const X share = (x - knots_[0]) / (knots_[1] - knots_[0]);
    const X inside = scalar(share) < 0 ? X(0) : scalar(share) > 1 ? X(1) : share;
    const double piece = std::min(std::floor(scalar(inside) * pieces), pieces - 1);
    const X t = inside * pieces - piece;
    const X s = 1.0 - t;
    return {{s * s * s / 6.0, (4.0 - 6.0 * t * t + 3.0 * t * t * t) / 6.0,
             (4.0 - 6.0 * s * s + 3.0 * s * s * s) / 6.0, t * t * t / 6.0},
            static_cast<std::size_t>(piece)};
  }
  template <class X, class T>
  T sum_of_splines(const X& x, std::span<const T> coefficients) const {
    const auto [weights, first] = splines_about(x);
    T sum(0);
    for (std::size_t k = 0; k < weights.size(); ++k) {
      const std::size_t spline = first + k;
      if (spline != omitted()) sum += weights[k] * coefficients[spline - (spline > omitted() ? 1 : 0)];
    }
    return sum;
  }
  std::size_t omitted() const { return static_cast<std::size_t>(first_); }

  Kind kind_;
  int first_;                  // order
  int last_;                   // order, or number of B-splines
  std::vector<double> knots_;  // of B-splines: both ends, and where the sum is 0
  bool is_fine_ = false;
};

/// Describes a departure by its shape: what is off, over what. It is the general member of a cause's family
/// where only that cause has its invariances, and else a departure that no cause of the catalogue explains.
class EmpiricalTerm final : public DifferentiableTerm<EmpiricalTerm> {
 public:
  enum class On { kRange, kMirrorAngle, kElevation, kPlateAngle, kLag, kBase, kTilt };
  enum class Over { kMirrorAngle, kPlateAngle, kRange, kIncidence, kRemission, kTime, kPlateRate };

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
        return change_by(T(beam.hub_time / p.back()), beam, p);
      case Over::kPlateRate:
        return change_by(T(beam.plate_rate), beam, p);
    }
  }

 private:
  /// √(−ln cos β), in which both 1/cos β and β are smooth.
  static double incidence(double cosine) {
    constexpr double kGrazing = 0.03;
    return std::sqrt(-std::log(std::clamp(std::abs(cosine), kGrazing, 1.0)));
  }

  template <class X, class T>
  void change_by(const X& x, Beam<T>& beam, std::span<const T> p) const {
    const auto shape = [&] { return shape_.at(x, p.first(shape_.coefficients())); };
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
        beam.origin += along_axes(x, p);
        break;
      case On::kTilt: {
        const Vector3<T> turn = along_axes(x, p);
        rotate(beam, Rotation<T>(turn.x(), turn.y(), turn.z()));
        break;
      }
    }
  }
  template <class X, class T>
  Vector3<T> along_axes(const X& x, std::span<const T> p) const {
    const std::size_t n = shape_.coefficients();
    return {shape_.at(x, p.first(n)), shape_.at(x, p.subspan(n, n)), shape_.at(x, p.subspan(2 * n, n))};
  }

  On on_;
  Over over_;
  Shape shape_;
  TermInfo info_;
};

}  // namespace crisp
