// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/clocks/lower_hull.hpp"

#include <algorithm>
#include <cmath>

namespace crisp::clocks {

bool LowerHull::is_above(const Stamp& left, const Stamp& middle, const Stamp& right) const {
  const double rise = (height(middle) - height(left)) * (right.device - left.device);
  return rise >= (height(right) - height(left)) * (middle.device - left.device);
}

void LowerHull::add(Stamp stamp) {
  if (!vertices_.empty() && vertices_.back().device == stamp.device) {
    if (vertices_.back().lead <= stamp.lead) return;
    vertices_.pop_back();
  }
  while (vertices_.size() > 1 && is_above(vertices_.end()[-2], vertices_.back(), stamp)) vertices_.pop_back();
  vertices_.push_back(stamp);
}

void LowerHull::forget_before(double device) {
  const auto keep = std::find_if(vertices_.begin(), vertices_.end(),
                                 [&](const Stamp& vertex) { return vertex.device >= device; });
  vertices_.erase(vertices_.begin(), keep);
}

void HullClock::add(Stamp stamp) {
  hull_.add(stamp);
  mean_ += (stamp.device - mean_) / static_cast<double>(++count_);
  // The mean only moves forward, and each vertex that is passed was added once: O(1) on the average.
  const auto vertices = hull_.vertices();
  edge_ = vertices.size() < 2 ? 0 : std::min(edge_, vertices.size() - 2);
  while (edge_ + 2 < vertices.size() && vertices[edge_ + 1].device <= mean_) ++edge_;
}

ClockLine HullClock::line() const {
  if (count_ == 0) return {};
  const auto vertices = hull_.vertices();
  const auto line =
      line_by_convex_hull(vertices.subspan(edge_, std::min<std::size_t>(2, vertices.size())), mean_);
  return std::abs(line.slope) < kMaxSkew ? line : line_by_convex_hull(vertices, mean_);
}

}  // namespace crisp::clocks
