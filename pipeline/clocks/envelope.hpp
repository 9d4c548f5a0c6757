// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

#include "pipeline/clocks/clock_line.hpp"

namespace crisp {

/// The lower envelope of receipt less device time, which queues in the network do not move: the stamp of
/// least delay in each of some stretches of a recording.
struct Envelope {
  std::vector<std::size_t> stamp;  ///< which is each stretch's least
  std::vector<std::size_t> first;  ///< each stretch's first stamp; one more than there are stretches
  Eigen::VectorXd time;            ///< [s] receipt, on the stamps' own scale
  Eigen::VectorXd lead;            ///< [s]

  Eigen::MatrixXd straight() const;  ///< n × 2: a constant, and time about its mean
  double line(const Eigen::VectorXd& values, double time) const;  ///< by coefficients of straight()
};

/// [s] When a stamp came in.
inline double receipt_of(const Stamp& stamp) { return stamp.device + stamp.lead; }

/// @param stamps at least six, in order of their receipt. There are up to 64 stretches, each of 12 stamps or
///               more if there are so many.
Envelope envelope_of(std::span<const Stamp> stamps);

/// What is tried beside a straight line: a parabola first, then a step before each stretch but the outermost.
/// @param time    [s] the envelope's, n of them
/// @param margin  stretches at either end that no step divides
/// @return n × (1 + n − 2 margin + 1)
Eigen::MatrixXd bend_and_steps(const Eigen::VectorXd& time, Eigen::Index margin);

/// The first stamp after a step of the envelope: all before a step up, and all after a step down, come in
/// earlier than half-way between.
/// @param step   [s]
/// @param level  [s] → [s]: the envelope without the step, at a time of receipt
template <class Level>
std::size_t first_after(std::span<const Stamp> stamps, double step, const Level& level) {
  const auto is_early = [&](const Stamp& s) { return s.lead - level(receipt_of(s)) < step / 2; };
  if (step < 0) return static_cast<std::size_t>(std::ranges::find_if(stamps, is_early) - stamps.begin());
  std::size_t i = stamps.size();
  while (i > 0 && !is_early(stamps[i - 1])) --i;
  return i;
}

}  // namespace crisp
