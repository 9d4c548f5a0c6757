// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/simulate/motion.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include <crisp/error.hpp>

#include "pipeline/data/internal_error.hpp"
#include "pipeline/statistics/random_stream.hpp"

namespace crisp::simulate {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;

/// Integral of the smooth step u²(3 − 2u) from 0 to u.
double smooth_step_integral(double u) { return u * u * u * (1 - u / 2); }

using Knots = std::vector<Motion::Knot>;

Knots varying(const MotionSettings& settings, double duration, statistics::RandomStream& random) {
  Knots knots;
  for (double t = 0; knots.size() < 2 || knots.back().time < duration;) {
    knots.push_back({t, kTurn * random.uniform(settings.min_rate, settings.max_rate)});
    t += settings.change_time * random.uniform(0.7, 1.3);
  }
  return knots;
}

/// Alternates between two rates, holding each for hold_time.
Knots alternating(const MotionSettings& settings, double duration, double first_rate, double second_rate) {
  Knots knots;
  double t = 0;
  for (int i = 0; t <= duration; ++i) {
    const double rate = kTurn * (i % 2 == 0 ? first_rate : second_rate);
    knots.push_back({t, rate});
    if (settings.hold_time > 0) knots.push_back({t + settings.hold_time, rate});
    t += settings.hold_time + settings.change_time;
  }
  return knots;
}

void check(const MotionSettings& settings, double duration) {
  if (!(duration > 0)) {
    throw Error(fmt::format("the simulation lasts {:g} s", duration), "give a duration above 0 s");
  }
  if (!std::isfinite(settings.min_rate) || !std::isfinite(settings.max_rate) ||
      settings.min_rate > settings.max_rate) {
    throw Error(fmt::format("the plate's min_rate of {:g} Hz is above its max_rate of {:g} Hz",
                            settings.min_rate, settings.max_rate),
                "give the lower rate as min_rate");
  }
  if (!(settings.change_time > 0)) {
    throw Error(fmt::format("the plate changes its speed within {:g} s", settings.change_time),
                "give a change_time above 0 s");
  }
  if (!(settings.hold_time >= 0)) {
    throw Error(fmt::format("the plate holds its speed for {:g} s", settings.hold_time),
                "give a hold_time of 0 s or more");
  }
}

}  // namespace

Motion::Motion(std::vector<Knot> knots, double first_angle) : knots_(std::move(knots)) {
  if (knots_.empty())
    throw Error("the motion of the plate has no knot", "give one time and one rate at least");
  angles_.push_back(first_angle);
  for (std::size_t i = 1; i < knots_.size(); ++i) {
    const double width = knots_[i].time - knots_[i - 1].time;
    if (!(width > 0)) {
      throw Error(
          fmt::format("the plate's motion has {:g} s after {:g} s", knots_[i].time, knots_[i - 1].time),
          "give its knots in ascending order of time");
    }
    angles_.push_back(angles_.back() + width * (knots_[i].rate + knots_[i - 1].rate) / 2);
  }
}

std::optional<PlateState> Motion::at(double t) const {
  const auto next = std::upper_bound(knots_.begin(), knots_.end(), t,
                                     [](double time, const Knot& k) { return time < k.time; });
  if (next == knots_.begin() || next == knots_.end()) {
    const std::size_t end = next == knots_.begin() ? 0 : knots_.size() - 1;
    return PlateState{.angle = angles_[end] + knots_[end].rate * (t - knots_[end].time),
                      .rate = knots_[end].rate};
  }
  const Knot& from = *std::prev(next);
  const double width = next->time - from.time;
  const double u = (t - from.time) / width;
  const double change = next->rate - from.rate;
  const double angle = angles_[static_cast<std::size_t>(std::prev(next) - knots_.begin())];
  return PlateState{.angle = angle + width * (from.rate * u + change * smooth_step_integral(u)),
                    .rate = from.rate + change * u * u * (3 - 2 * u),
                    .acceleration = change * 6 * u * (1 - u) / width};
}

Motion make_motion(const MotionSettings& settings, double duration, std::uint64_t seed) {
  check(settings, duration);
  statistics::RandomStream random(seed, "plate.motion");
  const double first_angle = random.uniform(0, kTurn);
  switch (settings.kind) {
    case MotionKind::constant:
      return Motion({{0, kTurn * settings.max_rate}}, first_angle);
    case MotionKind::varying:
      return Motion(varying(settings, duration, random), first_angle);
    case MotionKind::reversal:
      return Motion(alternating(settings, duration, settings.max_rate, -settings.max_rate), first_angle);
    case MotionKind::stop_and_go:
      return Motion(alternating(settings, duration, 0, settings.max_rate), first_angle);
  }
  throw data::internal_error("the motion of the plate is of no known kind");
}

}  // namespace crisp::simulate
