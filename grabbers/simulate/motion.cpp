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

/// Inverse of the smooth step: u with u²(3 − 2u) = rise, for a rise from 0 to 1.
double smooth_step_inverse(double rise) { return 0.5 - std::sin(std::asin(1 - 2 * rise) / 3); }

using Knots = std::vector<Motion::Knot>;

/// Sign of the first rate that is not 0.
double first_direction(const Knots& knots) {
  const auto turning = std::ranges::find_if(knots, [](const Motion::Knot& knot) { return knot.rate != 0; });
  return turning == knots.end() ? 0 : std::copysign(1.0, turning->rate);
}

/// The state with its direction, by the play of the motion before it.
PlateState with_direction(data::Play play, PlateState state) {
  state.direction = play.follow(state.angle);
  if (std::abs(state.direction) < 1) state.direction_rate = state.rate / data::Play::kHalf;
  return state;
}

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
  plays_.emplace_back(first_angle, first_direction(knots_));
  for (std::size_t i = 1; i < knots_.size(); ++i) {
    const double width = knots_[i].time - knots_[i - 1].time;
    if (!(width > 0)) {
      throw Error(
          fmt::format("the plate's motion has {:g} s after {:g} s", knots_[i].time, knots_[i - 1].time),
          "give its knots in ascending order of time");
    }
    angles_.push_back(angles_.back() + width * (knots_[i].rate + knots_[i - 1].rate) / 2);
    plays_.push_back(play_after(i - 1, knots_[i].time));
    plays_.back().follow(angles_.back());
  }
}

std::optional<PlateState> Motion::at(double t) const {
  const auto next = std::upper_bound(knots_.begin(), knots_.end(), t,
                                     [](double time, const Knot& k) { return time < k.time; });
  if (next == knots_.begin()) {
    const Knot& first = knots_.front();
    return PlateState{.angle = angles_.front() + first.rate * (t - first.time),
                      .rate = first.rate,
                      .direction = data::Play(plays_.front()).follow(angles_.front())};
  }
  if (next == knots_.end()) {
    const Knot& last = knots_.back();
    return with_direction(plays_.back(),
                          {.angle = angles_.back() + last.rate * (t - last.time), .rate = last.rate});
  }
  const auto from = static_cast<std::size_t>(std::prev(next) - knots_.begin());
  return with_direction(play_after(from, t), between(from, t));
}

/// The plate between a knot and the next one, without its direction.
PlateState Motion::between(std::size_t from, double t) const {
  const auto& [time, rate] = knots_[from];
  const double width = knots_[from + 1].time - time;
  const double u = (t - time) / width;
  const double change = knots_[from + 1].rate - rate;
  return {.angle = angles_[from] + width * (rate * u + change * smooth_step_integral(u)),
          .rate = rate + change * u * u * (3 - 2 * u),
          .acceleration = change * 6 * u * (1 - u) / width};
}

/// The play of the last monotone motion before time t, between a knot and the next one.
data::Play Motion::play_after(std::size_t from, double t) const {
  data::Play play = plays_[from];
  const auto& [time, rate] = knots_[from];
  const Knot& next = knots_[from + 1];
  if (rate * next.rate >= 0) return play;
  const double reversal = time + (next.time - time) * smooth_step_inverse(rate / (rate - next.rate));
  if (t > reversal) play.follow(between(from, reversal).angle);
  return play;
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
