// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <boost/container/static_vector.hpp>
#include <cmath>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "pipeline/model/chain.hpp"

namespace crisp::model {

/// What the coefficients of a shape count for at one place: the index of each, and its weight. Those that are
/// left out count nothing.
template <class X>
using ShapeWeights = boost::container::static_vector<std::pair<std::size_t, X>, 12>;

template <class X, class P>
auto sum(const ShapeWeights<X>& weights, std::span<const P> coefficients) {
  decltype(X() * P()) result(0);
  for (const auto& [k, weight] : weights) result += weight * coefficients[k];
  return result;
}

/// A function of one number with n coefficients, in which it is linear.
class Shape {
 public:
  /// Σ aₖ cos kx + bₖ sin kx for the orders k from `first` ≥ 1 to `last` ≤ 6.
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

  /// @param x  X is double for a covariate that the model does not change, or a Jet
  template <class X>
  ShapeWeights<X> weights(const X& x) const {
    switch (kind_) {
      case Kind::kFourier:
        return harmonics(x);
      case Kind::kHats:
        return hats_at(x);
      case Kind::kSplines:
        return splines_at(x);
      case Kind::kPowers:
        return {{0, x * x}, {1, x * (scalar(x) < 0 ? X(-x) : x)}, {2, x * x * x}};
      case Kind::kCurve:
        return {{0, x * x}, {1, x * x * x}};
    }
    return {};
  }

 private:
  enum class Kind { kFourier, kHats, kSplines, kPowers, kCurve };
  explicit Shape(Kind kind) : kind_(kind) {}

  template <class X>
  ShapeWeights<X> harmonics(const X& x) const {
    using std::cos;
    using std::sin;
    const X c = cos(x);
    const X s = sin(x);
    X cosine = c;
    X sine = s;
    ShapeWeights<X> weights;
    for (std::size_t order = 1; weights.size() < coefficients(); ++order) {
      if (order >= first_order_) {
        weights.emplace_back(weights.size(), cosine);
        weights.emplace_back(weights.size(), sine);
      }
      const X before = cosine;
      cosine = before * c - sine * s;
      sine = sine * c + before * s;
    }
    return weights;
  }
  template <class X>
  ShapeWeights<X> hats_at(const X& x) const {
    const auto above = std::ranges::upper_bound(knots_, scalar(x));
    if (above == knots_.begin()) return {{0, X(1)}};
    if (above == knots_.end()) return {{knots_.size() - 1, X(1)}};
    const auto k = static_cast<std::size_t>(above - knots_.begin());
    const X share = (x - knots_[k - 1]) / (knots_[k] - knots_[k - 1]);
    return {{k - 1, 1.0 - share}, {k, share}};
  }
  template <class X>
  ShapeWeights<X> splines_at(const X& x) const {
    ShapeWeights<X> weights;
    const auto add = [&](std::size_t spline, const X& weight) {
      if (spline != omitted_) weights.emplace_back(spline - (spline > omitted_ ? 1 : 0), weight);
    };
    const auto [own, first] = splines_about(x);
    for (std::size_t k = 0; k < own.size(); ++k) add(first + k, own[k]);
    for (std::size_t k = 0; k < at_zero_.size(); ++k) add(first_at_zero_ + k, X(-at_zero_[k]));
    return weights;
  }
  /// The four B-splines at x, and the first of them.
  template <class X>
  std::pair<std::array<X, 4>, std::size_t> splines_about(const X& x) const {
    const auto pieces = static_cast<double>(count_ - 3);
    const X share = (x - knots_[0]) / (knots_[1] - knots_[0]);
    const X inside = scalar(share) < 0 ? X(0) : scalar(share) > 1 ? X(1) : share;
    const double piece = std::min(std::floor(scalar(inside) * pieces), pieces - 1);
    const X t = inside * pieces - piece;
    const X s = 1.0 - t;
    return {{s * s * s / 6.0, (4.0 - 6.0 * t * t + 3.0 * t * t * t) / 6.0,
             (4.0 - 6.0 * s * s + 3.0 * s * s * s) / 6.0, t * t * t / 6.0},
            static_cast<std::size_t>(piece)};
  }

  Kind kind_;
  std::size_t count_ = 0;            // of orders or B-splines
  std::size_t first_order_ = 1;      // of cosines and sines
  std::vector<double> knots_;        // of hats; or both ends of the B-splines
  std::size_t omitted_ = 0;          // B-spline whose coefficient is 0
  std::array<double, 4> at_zero_{};  // B-splines where their sum is 0
  std::size_t first_at_zero_ = 0;
  bool is_fine_ = false;
};

}  // namespace crisp::model
