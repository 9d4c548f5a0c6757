// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/quality/view_flatness.hpp"

#include <algorithm>
#include <cmath>

#include "pipeline/quality/sort_unique.hpp"

namespace crisp::quality {
namespace {

constexpr double kMaxTilt = 0.1;  // [rad] of a view against all: beyond, it sees another side of an edge

}  // namespace

ViewNumbers::ViewNumbers(const BeamsView& beams) : of_beam(beams.points.size(), 0) {
  std::vector<std::uint32_t> known;
  for (std::size_t i = 0; i < beams.views.size(); ++i) {
    if (i == 0 || beams.views[i] != beams.views[i - 1]) known.push_back(beams.views[i]);
  }
  sort_once(known);
  for (std::size_t i = 0; i < beams.views.size(); ++i) {
    of_beam[i] = static_cast<std::uint32_t>(std::ranges::lower_bound(known, beams.views[i]) - known.begin());
  }
  count = std::max<std::size_t>(known.size(), 1);
}

bool ViewFlatness::is_flat(std::span<const std::uint32_t> members, const Plane& plane,
                           const Eigen::Vector3d& origin) {
  const auto& at = beams_.points;
  const auto& along = beams_.directions;
  for (const std::uint32_t i : members) {
    const Eigen::Vector3d offset = Eigen::Vector3d(at.x[i], at.y[i], at.z[i]) - origin - plane.middle;
    const double incidence = plane.normal.dot(Eigen::Vector3d(along.x[i], along.y[i], along.z[i]));
    const double variance = std::pow(settings_.noise * incidence, 2) + std::pow(settings_.floor, 2);
    ViewSums& sums = sums_[views_.of_beam[i]];
    if (sums.count() == 0) in_use_.push_back(views_.of_beam[i]);
    sums.add(plane.u.dot(offset), plane.v.dot(offset), plane.normal.dot(offset), 1 / variance);
  }
  double left = 0;
  double degrees_of_freedom = 0;
  double tilt = 0;
  for (const std::uint32_t view : in_use_) {
    const Eigen::Vector3d fit = sums_[view].fit();
    tilt = std::max(tilt, fit.tail<2>().norm());
    left += sums_[view].squares_left(fit);
    degrees_of_freedom += sums_[view].degrees_of_freedom();
    sums_[view] = {};
  }
  in_use_.clear();
  if (degrees_of_freedom < 3 || tilt > kMaxTilt) return false;
  return left / degrees_of_freedom <= 1 + settings_.max_excess + 3 * std::sqrt(2 / degrees_of_freedom);
}

}  // namespace crisp::quality
