// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/diagnose/unexplained.hpp"

#include <algorithm>
#include <optional>

namespace crisp {
namespace {

constexpr const char* kLeavesMore =
    "it takes less than what departs from the extended model all the same, and may be no more than a part of "
    "that";

/// [m²] What departs where this one is, over the covariate that shows the most.
double unexplained_beside(const Departure& one, const std::vector<Departure>& departures,
                          const SideBySide& left, double noise) {
  const std::optional<std::size_t> laser = one.candidate.laser();
  auto squares = left.unexplained(laser);
  for (const Departure& shape : departures) {
    const bool is_there = !laser || shape.candidate.laser() == laser;
    if (shape.candidate.is_cause() || !shape.accepted || !is_there) continue;
    const auto over = squares.find(shape.candidate.covariate);
    if (over != squares.end()) over->second += shape.square(noise);
  }
  double most = 0;
  for (const auto& [covariate, square] : squares) most = std::max(most, square);
  return most;
}

}  // namespace

bool refuse_what_leaves_more(std::vector<Departure>& departures, const SideBySide& left, double noise) {
  bool refuses = false;
  for (Departure& one : departures) {
    if (!one.accepted || !one.candidate.is_cause()) continue;
    one.unexplained = unexplained_beside(one, departures, left, noise);
    if (one.square(noise) >= one.unexplained) continue;
    one.refuse(kLeavesMore);
    refuses = true;
  }
  return refuses;
}

}  // namespace crisp
