// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/quality/view_planes.hpp"

#include <algorithm>
#include <cmath>

namespace crisp::quality {
namespace {

/// Weighted squares of the distances from the view's own plane.
double squares_left(const Moments& moments, double beams, const Plane& plane) {
  const ViewSums sums = ViewSums::of(moments, beams, plane);
  return sums.squares_left(sums.fit());
}

}  // namespace

ViewPlanes::OfView& ViewPlanes::of(std::uint32_t view) {
  const auto own = std::ranges::lower_bound(views_, view, {}, &OfView::view);
  if (own != views_.end() && own->view == view) return *own;
  return *views_.insert(own, {.view = view, .beams = 0, .moments = {}});
}

void ViewPlanes::add(std::uint32_t view, const Eigen::Vector3d& point, double weight) {
  OfView& own = of(view);
  own.beams += 1;
  own.moments.add(point, weight);
}

ViewPlanes& ViewPlanes::operator+=(const ViewPlanes& other) {
  for (const OfView& more : other.views_) {
    OfView& own = of(more.view);
    own.beams += more.beams;
    own.moments += more.moments;
  }
  return *this;
}

bool ViewPlanes::continues(const ViewPlanes& other, const Plane& plane, double bump) const {
  constexpr double kLost = 3;    // parameters of a plane
  constexpr double kChance = 4;  // standard deviations
  double worse = 0;
  double lost = 0;
  double bumps = 0;  // allowed, on the smaller piece
  auto own = views_.begin();
  for (const OfView& their : other.views_) {
    own = std::lower_bound(own, views_.end(), their.view,
                           [](const OfView& of, std::uint32_t view) { return of.view < view; });
    if (own == views_.end()) break;
    if (own->view != their.view || own->beams <= kLost || their.beams <= kLost) continue;
    Moments both = own->moments;
    both += their.moments;
    worse += squares_left(both, own->beams + their.beams, plane) -
             squares_left(own->moments, own->beams, plane) - squares_left(their.moments, their.beams, plane);
    bumps += bump * bump * std::min(own->beams, their.beams);
    lost += kLost;
  }
  return worse <= lost + kChance * std::sqrt(2 * lost) + bumps;
}

}  // namespace crisp::quality
