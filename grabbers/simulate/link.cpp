// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/simulate/link.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include <crisp/error.hpp>

namespace crisp::simulate {

LinkSettings with_bursts(LinkSettings link, const BurstSettings& bursts) {
  if (!(bursts.interval > 0 && bursts.wait > 0)) {
    throw Error("telegrams that come in bursts need an interval and a wait above 0",
                "give latency.bursts both");
  }
  // Stalls of a mean duration T hold a share h of what is sent. By T on the mean, and as long again is a
  // stall that has lasted for a while: delays have the variance (2 h − h²) T², and exp(−interval / T) of what
  // is held was not the first to be.
  const auto duration = [&](double held) { return bursts.wait / std::sqrt(held * (2 - held)); };
  const auto together = [&](double held) { return held * std::exp(-bursts.interval / duration(held)); };
  constexpr double kMaxHeld = 0.999;
  double least = 0;
  double most = kMaxHeld;
  if (together(most) < bursts.together) {
    throw Error(fmt::format("no link holds back a share of {:.3g} of its telegrams together by {:.3g} s only",
                            bursts.together, bursts.wait),
                "raise latency.bursts.wait, or lower together");
  }
  constexpr int kHalvings = 60;
  for (int step = 0; step < kHalvings; ++step) {
    const double held = (least + most) / 2;
    (together(held) < bursts.together ? least : most) = held;
  }
  link.stall_time = duration(most);
  link.stall_rate = most / (1 - most) / link.stall_time;
  return link;
}

Link::Link(const LinkSettings& settings, double minimum, std::uint64_t seed, const std::string& name,
           Step step)
    : settings_(settings),
      minimum_(minimum),
      scale_(settings.jitter / std::tgamma(1 + 1 / settings.shape)),
      step_(step),
      jitter_(seed, name + ".link.jitter"),
      stalls_(seed, name + ".link.stalls"),
      last_arrival_(-std::numeric_limits<double>::infinity()) {
  if (!(minimum >= 0 && minimum + step.by >= 0 && settings.jitter >= 0 && settings.shape > 0 &&
        settings.stall_rate >= 0 && settings.stall_time >= 0 && settings.seconds_per_byte >= 0)) {
    throw Error("a delay or a rate of the link of " + name + " is below 0",
                "give delays, jitters and stalls of 0 or more, also with latency.step");
  }
  const double never = std::numeric_limits<double>::infinity();
  stall_begin_ = settings.stall_rate > 0 ? stalls_.exponential(1 / settings.stall_rate) : never;
  stall_end_ = settings.stall_rate > 0 ? stall_begin_ + stalls_.exponential(settings.stall_time) : never;
}

double Link::arrival(double sent, std::size_t bytes) {
  while (sent >= stall_end_) {
    stall_begin_ = stall_end_ + stalls_.exponential(1 / settings_.stall_rate);
    stall_end_ = stall_begin_ + stalls_.exponential(settings_.stall_time);
  }
  const double handed_on = sent >= stall_begin_ ? stall_end_ : sent;
  const double free = last_arrival_ + static_cast<double>(bytes) * settings_.seconds_per_byte;
  const double jitter = scale_ * std::pow(jitter_.exponential(1), 1 / settings_.shape);
  last_arrival_ = std::max(handed_on + minimum_ + step_.before(sent) + jitter, free);
  return last_arrival_;
}

}  // namespace crisp::simulate
