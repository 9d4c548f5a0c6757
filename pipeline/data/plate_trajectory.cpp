// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>

#include <crisp/error.hpp>
#include <crisp/plate_trajectory.hpp>

#include "pipeline/data/play.hpp"

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

/// Sign of the first motion by more than the noise of readings, as if the plate had turned so before, too.
double first_direction(std::span<const double> angles) {
  const auto turned = std::ranges::find_if(
      angles, [&](double angle) { return std::abs(angle - angles.front()) > data::kReversalTravel; });
  return turned == angles.end() ? 0 : std::copysign(1.0, *turned - angles.front());
}

/// PlateState::direction at each reading. Starts anew after a silence longer than `max_gap`.
std::vector<double> turning_directions(std::span<const double> times, std::span<const double> angles,
                                       double max_gap) {
  std::vector<double> directions;
  directions.reserve(angles.size());
  while (directions.size() < angles.size()) {
    const std::size_t begin = directions.size();
    std::size_t end = begin + 1;
    while (end < angles.size() && times[end] - times[end - 1] <= max_gap) ++end;
    const auto part = angles.subspan(begin, end - begin);
    data::Play play(part.front(), first_direction(part));
    for (const double angle : part) directions.push_back(play.follow(angle));
  }
  return directions;
}

}  // namespace

PlateTrajectory::PlateTrajectory(std::int64_t epoch_ns, std::vector<double> times, std::vector<double> angles,
                                 double max_gap, std::vector<double> new_zeros)
    : epoch_ns_(epoch_ns),
      times_(std::move(times)),
      angles_(std::move(angles)),
      new_zeros_(std::move(new_zeros)),
      max_gap_(max_gap) {
  if (times_.size() != angles_.size())
    throw Error(fmt::format("a plate trajectory has {} times and {} angles", times_.size(), angles_.size()),
                "give one angle for each time");
  const auto late = std::adjacent_find(times_.begin(), times_.end(), std::greater_equal<>());
  if (late != times_.end()) {
    throw Error(fmt::format("the time of encoder reading {} is {} s, and that of the next is {} s",
                            late - times_.begin() + 1, *late, *std::next(late)),
                "give readings in ascending order of time, without repetition");
  }
  rates_ = slopes(times_, angles_);
  directions_ = turning_directions(times_, angles_, max_gap_);
  if (times_.size() < 2) return;
  const std::size_t intervals = times_.size() - 1;
  first_.assign(intervals + 1, 0);
  parts_a_second_ = static_cast<double>(intervals) / (times_.back() - times_.front());
  for (std::size_t i = 0; i < intervals; ++i) first_[part_of(times_[i]) + 1] = static_cast<std::uint32_t>(i);
  std::partial_sum(first_.begin(), first_.end(), first_.begin(),
                   [](std::uint32_t before, std::uint32_t own) { return std::max(before, own); });
}

PlateState PlateArc::at(double t) const {
  const double u = (t - begin) / width;
  const auto& c = coefficients;
  return {.angle = c[0] + u * (c[1] + u * (c[2] + u * c[3])),
          .rate = (c[1] + u * (2 * c[2] + u * 3 * c[3])) / width,
          .acceleration = (2 * c[2] + u * 6 * c[3]) / (width * width),
          .direction = directions[0] + u * (directions[1] - directions[0]),
          .direction_rate = (directions[1] - directions[0]) / width};
}

PlateTrajectory PlateTrajectory::with_angles(std::vector<double> angles) const {
  return {epoch_ns_, times_, std::move(angles), max_gap_, new_zeros_};
}

std::optional<PlateArc> PlateTrajectory::arc(double t) const {
  const auto found = interval(t);
  if (!found) return std::nullopt;
  const double width = times_[*found + 1] - times_[*found];
  const double rise = angles_[*found + 1] - angles_[*found];
  const double m0 = rates_[*found] * width;
  const double m1 = rates_[*found + 1] * width;
  return PlateArc{.begin = times_[*found],
                  .end = times_[*found + 1],
                  .width = width,
                  .coefficients = {angles_[*found], m0, 3 * rise - 2 * m0 - m1, m0 + m1 - 2 * rise},
                  .directions = {directions_[*found], directions_[*found + 1]}};
}

std::optional<PlateState> PlateTrajectory::at(double t) const {
  const auto found = arc(t);
  return found ? std::optional(found->at(t)) : std::nullopt;
}

}  // namespace crisp
