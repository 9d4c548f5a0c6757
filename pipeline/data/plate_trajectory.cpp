// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/data/plate_trajectory.hpp"

#include <algorithm>
#include <cmath>

#include "pipeline/data/error.hpp"

namespace crisp {
namespace {

/// Slope at the middle of three points: the derivative of the parabola through them.
double middle_slope(double t0, double t1, double t2, double y0, double y1, double y2) {
  const double before = t1 - t0;
  const double after = t2 - t1;
  return ((y1 - y0) / before * after + (y2 - y1) / after * before) / (before + after);
}

std::vector<double> slopes(std::span<const double> t, std::span<const double> y) {
  const std::size_t n = t.size();
  std::vector<double> slope(n, 0.0);
  if (n < 2) return slope;
  for (std::size_t i = 1; i + 1 < n; ++i) {
    slope[i] = middle_slope(t[i - 1], t[i], t[i + 1], y[i - 1], y[i], y[i + 1]);
  }
  slope.front() = (y[1] - y[0]) / (t[1] - t[0]);
  slope.back() = (y[n - 1] - y[n - 2]) / (t[n - 1] - t[n - 2]);
  return slope;
}

}  // namespace

PlateTrajectory::PlateTrajectory(std::int64_t epoch_ns, std::vector<double> times, std::vector<double> angles,
                                 double max_gap, std::vector<double> new_zeros)
    : epoch_ns_(epoch_ns),
      times_(std::move(times)),
      angles_(std::move(angles)),
      new_zeros_(std::move(new_zeros)),
      max_gap_(max_gap) {
  if (times_.size() != angles_.size()) throw Error("a plate trajectory needs one angle for each time");
  if (std::adjacent_find(times_.begin(), times_.end(), std::greater_equal<>()) != times_.end()) {
    throw Error("the times of a plate trajectory must ascend");
  }
  rates_ = slopes(times_, angles_);
}

PlateState PlateArc::at(double t) const {
  const double u = (t - begin) / width;
  const auto& c = coefficients;
  return {.angle = c[0] + u * (c[1] + u * (c[2] + u * c[3])),
          .rate = (c[1] + u * (2 * c[2] + u * 3 * c[3])) / width,
          .acceleration = (2 * c[2] + u * 6 * c[3]) / (width * width)};
}

std::optional<PlateArc> PlateTrajectory::arc(std::size_t interval) const {
  const double width = times_[interval + 1] - times_[interval];
  if (width > max_gap_) return std::nullopt;
  const double rise = angles_[interval + 1] - angles_[interval];
  const double m0 = rates_[interval] * width;
  const double m1 = rates_[interval + 1] * width;
  return PlateArc{.begin = times_[interval],
                  .end = times_[interval + 1],
                  .width = width,
                  .coefficients = {angles_[interval], m0, 3 * rise - 2 * m0 - m1, m0 + m1 - 2 * rise}};
}

std::optional<PlateState> PlateTrajectory::at(double t) const {
  if (times_.size() < 2 || !(t >= times_.front() && t <= times_.back())) return std::nullopt;
  const auto next = std::upper_bound(times_.begin() + 1, times_.end() - 1, t);
  const auto found = arc(static_cast<std::size_t>(next - times_.begin()) - 1);
  return found ? std::optional(found->at(t)) : std::nullopt;
}

std::optional<PlateState> PlateTrajectory::Cursor::at(double t) {
  const auto found = arc(t);
  return found ? std::optional(found->at(t)) : std::nullopt;
}

std::optional<PlateArc> PlateTrajectory::Cursor::arc(double t) {
  const auto& times = trajectory_->times_;
  if (times.size() < 2 || !(t >= times.front() && t <= times.back())) return std::nullopt;
  constexpr int kSteps = 16;  // beyond these a bisection is cheaper than walking
  const auto last = static_cast<std::ptrdiff_t>(times.size() - 2);
  const auto most = static_cast<double>(last);
  for (int step = 0; step < kSteps; ++step) {
    const double from = times[interval_];
    const double to = times[interval_ + 1];
    if (t >= from && t <= to) return trajectory_->arc(interval_);
    // Readings are about even: as many intervals on as this one's width goes into the way.
    const double on = std::clamp((t - from) / (to - from), -most, most);
    auto whole = static_cast<std::ptrdiff_t>(on);  // rounded down, for which std::floor() may be a call
    if (on < static_cast<double>(whole)) --whole;
    interval_ = static_cast<std::size_t>(
        std::clamp(static_cast<std::ptrdiff_t>(interval_) + whole, std::ptrdiff_t{0}, last));
  }
  const auto next = std::upper_bound(times.begin() + 1, times.end() - 1, t);
  interval_ = static_cast<std::size_t>(next - times.begin()) - 1;
  return trajectory_->arc(interval_);
}

}  // namespace crisp
