// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

#include "pipeline/clocks/clock_line.hpp"

namespace crisp::clocks {

/// The lower envelope of receipt less device time, which queues in the network do not move: the stamp of
/// least delay in each of some stretches of a recording.
struct Envelope {
  std::vector<std::size_t> stamp;  ///< which is each stretch's least
  std::vector<std::size_t> first;  ///< each stretch's first stamp; one more than there are stretches
  Eigen::VectorXd time;            ///< [s] receipt, on the stamps' own scale
  Eigen::VectorXd lead;            ///< [s]

  Eigen::MatrixXd straight() const;  ///< n × 2: a constant, and time about its mean
  double line(const Eigen::VectorXd& values, double at) const;  ///< [s] by coefficients of straight()
};

/// [s] When a stamp came in.
inline double receipt_of(const Stamp& stamp) { return stamp.device + stamp.lead; }

/// @param stamps at least six, in order of their receipt. There are up to 64 stretches, each of 12 stamps or
///               more if there are so many.
Envelope envelope_of(std::span<const Stamp> stamps);

/// Regressors tested next to a straight line: a parabola first, then a step before each inner stretch.
/// @param time    [s] the envelope's, n of them
/// @param margin  stretches at either end that no step divides
/// @return n × (1 + n − 2 margin + 1)
Eigen::MatrixXd bend_and_steps(const Eigen::VectorXd& time, Eigen::Index margin);

/// Whether a stamp comes in earlier than half-way between the two levels of a step of the envelope: all
/// before a step up, and all after a step down, of which the delay is small enough.
/// @param step   [s]
/// @param level  [s] → [s]: the envelope without the step, at a time of receipt
template <class Level>
bool is_early(const Stamp& stamp, double step, const Level& level) {
  return stamp.lead - level(receipt_of(stamp)) < step / 2;
}

/// The first stamp after a step of the envelope, as far as early stamps resolve it.
template <class Level>
std::size_t first_after(std::span<const Stamp> stamps, double step, const Level& level) {
  const auto early = [&](const Stamp& s) { return is_early(s, step, level); };
  if (step < 0) return static_cast<std::size_t>(std::ranges::find_if(stamps, early) - stamps.begin());
  std::size_t i = stamps.size();
  while (i > 0 && !early(stamps[i - 1])) --i;
  return i;
}

/// The fraction of the stamps on the lower side of a step that are early; at least one of them.
template <class Level>
double early_share(std::span<const Stamp> stamps, double step, const Level& level) {
  const auto early = std::ranges::count_if(stamps, [&](const Stamp& s) { return is_early(s, step, level); });
  return static_cast<double>(std::max<std::ptrdiff_t>(1, early)) /
         static_cast<double>(std::max<std::size_t>(1, stamps.size()));
}

}  // namespace crisp::clocks
