// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <vector>

#include "pipeline/clocks/clock_line.hpp"

namespace crisp::clocks {

/// The lower convex hull of stamps that come in order of device time: amortised O(1) a stamp.
///
/// With a `bend` it keeps those stamps that can touch from above not only a line but a curve that bends
/// downwards by no more than that: the hull of lead + bend/2 · device². Every stamp that is left out lies
/// above every such curve below the ones that are kept.
class LowerHull {
 public:
  /// @param bend [1/s] largest change of a clock's rate in a second
  explicit LowerHull(double bend = 0) : bend_(bend) {}

  void add(Stamp stamp);
  /// Forgets the vertices before a device time [s].
  void forget_before(double device);
  std::span<const Stamp> vertices() const { return vertices_; }

 private:
  double height(const Stamp& stamp) const { return stamp.lead + 0.5 * bend_ * stamp.device * stamp.device; }
  bool is_above(const Stamp& left, const Stamp& middle, const Stamp& right) const;

  double bend_;
  std::vector<Stamp> vertices_;
};

/// The clock's line as stamps come in: after each, what line_by_convex_hull() gives for all of them.
/// Amortised O(1) a stamp, for a clock that is read while it is being fitted.
class HullClock {
 public:
  void add(Stamp stamp);
  /// @return a line through (0, 0) before the first stamp
  ClockLine line() const;

 private:
  LowerHull hull_;
  std::size_t edge_ = 0;  ///< index of the vertex where the edge at the mean begins
  std::size_t count_ = 0;
  double mean_ = 0;  ///< [s] of the device times
};

}  // namespace crisp::clocks
