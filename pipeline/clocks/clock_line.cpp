// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/clocks/clock_line.hpp"

#include <algorithm>
#include <cmath>

#include "pipeline/clocks/lower_hull.hpp"

namespace crisp {
namespace {

/// Index of the stamp that a line of this slope touches first from below.
std::size_t support(std::span<const Stamp> stamps, double slope) {
  const auto lower = [slope](const Stamp& a, const Stamp& b) {
    return a.lead - b.lead < slope * (a.device - b.device);
  };
  return static_cast<std::size_t>(std::min_element(stamps.begin(), stamps.end(), lower) - stamps.begin());
}

ClockLine line_through(const Stamp& stamp, double slope, double center) {
  return {.center = center, .at_center = stamp.lead + slope * (center - stamp.device), .slope = slope};
}

double slope_between(const Stamp& a, const Stamp& b) { return (b.lead - a.lead) / (b.device - a.device); }

}  // namespace

ClockLine line_by_convex_hull(std::span<const Stamp> stamps, double center) {
  LowerHull hull;
  for (const auto& stamp : stamps) hull.add(stamp);
  const auto vertices = hull.vertices();
  if (vertices.size() == 1) return line_through(vertices.front(), 0, center);
  const auto right = std::upper_bound(vertices.begin() + 1, vertices.end() - 1, center,
                                      [](double t, const Stamp& vertex) { return t < vertex.device; });
  const double slope = slope_between(right[-1], *right);
  if (std::abs(slope) <= kMaxSkew) return line_through(right[-1], slope, center);
  const double bound = std::copysign(kMaxSkew, slope);
  return line_through(vertices[support(vertices, bound)], bound, center);
}

}  // namespace crisp
