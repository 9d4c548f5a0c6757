// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/simulate/link.hpp"

#include <algorithm>
#include <limits>

#include "pipeline/data/error.hpp"

namespace crisp {

Link::Link(const LinkSettings& settings, double minimum, std::uint64_t seed, const std::string& name,
           Step step)
    : settings_(settings),
      minimum_(minimum),
      step_(step),
      jitter_(seed, name + ".link.jitter"),
      stalls_(seed, name + ".link.stalls"),
      last_arrival_(-std::numeric_limits<double>::infinity()) {
  if (!(minimum >= 0 && minimum + step.by >= 0 && settings.jitter >= 0 && settings.stall_rate >= 0 &&
        settings.stall_time >= 0 && settings.seconds_per_byte >= 0)) {
    throw Error("the delays of the link of " + name + " must not be negative");
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
  last_arrival_ =
      std::max(handed_on + minimum_ + step_.before(sent) + jitter_.exponential(settings_.jitter), free);
  return last_arrival_;
}

}  // namespace crisp
