// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/data/encoder_smoothing.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>

namespace crisp::data {
namespace {

constexpr int kTerms = 5;             // of a polynomial of the fourth degree
constexpr Eigen::Index kMin = 15;     // readings: fewer add little to the middle one
constexpr double kMaxOff = 0.55;      // steps: half a step of rounding, and a little for the stamps
constexpr double kMaxChange = 0.6;    // steps, likewise
constexpr double kMomentsAWidth = 4;  // that polynomials are found for

using Coefficients = Eigen::Matrix<double, kTerms, 1>;
using Squares = Eigen::Matrix<double, kTerms, kTerms>;
using Basis = Eigen::Matrix<double, Eigen::Dynamic, kTerms>;
using Rough = Eigen::Matrix<float, Eigen::Dynamic, kTerms>;

/// Legendre's polynomials after the first, 1: almost orthogonal where readings are even.
template <class Place>
std::array<Place, kTerms - 1> terms_at(const Place& u) {
  const Place u2 = u * u;
  return {u, 1.5 * u2 - 0.5, (2.5 * u2 - 1.5) * u, (4.375 * u2 - 3.75) * u2 + 0.375};
}

/// The plate's angle about a moment.
struct Arc {
  double middle = 0;          // [s]
  double half_width = 1;      // [s]
  Coefficients coefficients;  // [rad]

  double at(double time) const {
    const auto terms = terms_at((time - middle) / half_width);
    return coefficients[0] + coefficients.tail<kTerms - 1>().dot(Eigen::Vector4d(terms.data()));
  }
};

/// The readings about a moment.
class Window {
 public:
  Window(double middle, double half_width, std::span<const double> times, std::span<const double> angles,
         double step)
      : middle_(middle), half_width_(half_width), step_(step) {
    const auto first = std::ranges::lower_bound(times, middle - half_width) - times.begin();
    const auto last = std::ranges::upper_bound(times, middle + half_width) - times.begin();
    if (first == last) return;
    using Column = Eigen::Map<const Eigen::ArrayXd>;
    const auto terms =
        terms_at<Eigen::ArrayXd>((Column(times.data() + first, last - first) - middle) / half_width);
    basis_.resize(last - first, kTerms);
    basis_.col(0).setOnes();
    for (int k = 1; k < kTerms; ++k) basis_.col(k) = terms[static_cast<std::size_t>(k - 1)];
    rough_ = basis_.cast<float>();
    start_ = angles[static_cast<std::size_t>(first)];
    read_ = (Column(angles.data() + first, last - first) - start_) / step;
  }

  Eigen::Index size() const { return read_.size(); }

  Arc least_squares() const { return arc(solution()); }

  /// Far from the ends of what the readings allow; none if they do not allow any.
  std::optional<Arc> within_steps() const {
    Coefficients found = solution();
    Eigen::VectorXd left = read_ - basis_ * found;
    if (left.norm() > kMaxOff * std::sqrt(static_cast<double>(size()))) return std::nullopt;
    for (const int power : {4, 8, 16}) {  // each from where the one before it led
      found += step_towards_least(power, left);
      left = read_ - basis_ * found;
    }
    if (!(left.lpNorm<Eigen::Infinity>() <= kMaxOff)) return std::nullopt;
    return arc(found);
  }

 private:
  Arc arc(const Coefficients& found) const {
    Arc result{.middle = middle_, .half_width = half_width_, .coefficients = found * step_};
    result.coefficients[0] += start_;
    return result;
  }

  /// By least squares.
  Coefficients solution() const {
    const Squares squares = basis_.transpose().lazyProduct(basis_);
    return squares.ldlt().solve(basis_.transpose() * read_);
  }

  /// Newton's step towards the least sum of powers (4, 8 or 16) of what is left [steps]. Its direction
  /// need not be known to more than a float holds.
  Coefficients step_towards_least(int power, const Eigen::VectorXd& left) const {
    constexpr float kMinCurvature = 0.02F;  // where one reading stands out, the others still count
    constexpr double kNothing = 1e-9;       // steps
    const double most = left.lpNorm<Eigen::Infinity>();
    if (most < kNothing) return Coefficients::Zero();
    const Eigen::ArrayXf share = (left / most).cast<float>();
    Eigen::ArrayXf square = share.square();
    Eigen::ArrayXf curvature = square;  // share to the power less two
    for (int reached = 4; reached < power; reached *= 2) {
      square = square.square();
      curvature *= square;
    }
    const Rough weighted = rough_.array().colwise() * (curvature + kMinCurvature);
    Squares squares;
    for (int i = 0; i < kTerms; ++i) {
      for (int j = 0; j <= i; ++j) squares(i, j) = double{weighted.col(i).dot(rough_.col(j))};
    }
    const Coefficients slope = (rough_.transpose() * (curvature * share).matrix()).cast<double>();
    return squares.selfadjointView<Eigen::Lower>().ldlt().solve(slope) * (most / (power - 1));
  }

  double middle_;
  double half_width_;
  double step_;
  double start_ = 0;  // [rad]
  Basis basis_;
  Rough rough_;
  Eigen::VectorXd read_;  // [steps] from the start
};

/// None where readings are few.
std::optional<Arc> arc_about(double moment, std::span<const double> times, std::span<const double> angles,
                             double step, double half_width) {
  for (const double share : {1.0, 0.5}) {
    const Window window(moment, share * half_width, times, angles, step);
    if (window.size() < kMin) return std::nullopt;
    if (auto arc = window.within_steps()) return arc;
  }
  const Window narrowest(moment, 0.25 * half_width, times, angles, step);
  if (narrowest.size() < kMin) return std::nullopt;
  const auto arc = narrowest.within_steps();
  return arc ? arc : narrowest.least_squares();
}

}  // namespace

std::vector<double> between_steps(std::span<const double> times, std::span<const double> angles, double step,
                                  double half_width) {
  std::vector<double> smooth(angles.begin(), angles.end());
  if (times.empty() || !(half_width > 0)) return smooth;
  const double most = kMaxChange * step;
  // Moments are parts of time itself, so that a recording has the same ones in however many pieces it comes.
  const double apart = half_width / kMomentsAWidth;
  const auto arc_of = [&](double moment) {
    return arc_about(moment * apart, times, angles, step, half_width);
  };
  double latest = std::numeric_limits<double>::quiet_NaN();
  std::optional<Arc> before;
  std::optional<Arc> after;
  for (std::size_t i = 0; i < times.size(); ++i) {
    const double moment = std::floor(times[i] / apart);
    if (moment != latest) {
      before = moment == latest + 1 ? after : arc_of(moment);
      after = arc_of(moment + 1);
      latest = moment;
    }
    if (!before && !after) continue;
    const double share = times[i] / apart - moment;
    const double angle =
        std::lerp((before ? before : after)->at(times[i]), (after ? after : before)->at(times[i]), share);
    smooth[i] += std::clamp(angle - angles[i], -most, most);
  }
  return smooth;
}

}  // namespace crisp::data
