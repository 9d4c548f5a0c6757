// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/diagnose/model/residual_variance.hpp"

#include <algorithm>
#include <optional>

namespace crisp::diagnose {
namespace {

constexpr const char* kLeavesMore =
    "it explains less than the systematic residual that the extended model leaves, and may be a part of that residual";

/// [m²] Largest systematic residual over any covariate where this hypothesis applies.
double unexplained_given(const Hypothesis& one, const std::vector<Hypothesis>& hypotheses,
                         const ProfileComparison& left, double noise) {
  const std::optional<std::size_t> laser = one.candidate.laser();
  auto squares = left.unexplained(laser);
  for (const Hypothesis& shape : hypotheses) {
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

bool reject_if_residual_exceeds(std::vector<Hypothesis>& hypotheses, const ProfileComparison& left,
                                double noise) {
  bool has_rejected = false;
  for (Hypothesis& one : hypotheses) {
    if (!one.accepted || !one.candidate.is_cause()) continue;
    const double unexplained = unexplained_given(one, hypotheses, left, noise);
    one.decide({.name = "explained against residual mean square [m^2]",
                .statistic = one.square(noise),
                .threshold = unexplained,
                .passed = one.square(noise) >= unexplained},
               kLeavesMore);
    has_rejected = has_rejected || !one.accepted;
  }
  return has_rejected;
}

}  // namespace crisp::diagnose
