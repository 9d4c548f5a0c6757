// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/clocks/clock_line.hpp"

#include <algorithm>
#include <cmath>

#include "pipeline/clocks/lower_hull.hpp"

namespace crisp::clocks {
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

LowerHull hull_of(std::span<const Stamp> stamps) {
  LowerHull hull;
  for (const auto& stamp : stamps) hull.add(stamp);
  return hull;
}

/// The edge above or below which `center` lies: its vertices, of which there are two or more in all.
std::span<const Stamp> edge_at(std::span<const Stamp> vertices, double center) {
  const auto right = std::upper_bound(vertices.begin() + 1, vertices.end() - 1, center,
                                      [](double t, const Stamp& vertex) { return t < vertex.device; });
  return {right - 1, 2};
}

}  // namespace

double hull_slope(std::span<const Stamp> stamps, double center) {
  const LowerHull hull = hull_of(stamps);
  if (hull.vertices().size() == 1) return 0;
  const auto edge = edge_at(hull.vertices(), center);
  return slope_between(edge[0], edge[1]);
}

ClockLine line_by_convex_hull(std::span<const Stamp> stamps, double center) {
  const LowerHull hull = hull_of(stamps);
  const auto vertices = hull.vertices();
  if (vertices.size() == 1) return line_through(vertices.front(), 0, center);
  const auto edge = edge_at(vertices, center);
  const double slope = slope_between(edge[0], edge[1]);
  if (std::abs(slope) <= kMaxSkew) return line_through(edge[0], slope, center);
  const double bound = std::copysign(kMaxSkew, slope);
  return line_through(vertices[support(vertices, bound)], bound, center);
}

}  // namespace crisp::clocks
