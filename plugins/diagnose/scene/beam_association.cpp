// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/diagnose/scene/beam_association.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "pipeline/estimate/shared_errors.hpp"
#include "pipeline/quality/blocks.hpp"
#include "pipeline/quality/vector_at.hpp"
#include "pipeline/statistics/robust_estimators.hpp"

namespace crisp::diagnose {
namespace {

constexpr double kSide = 0.1;   // [m] of a cell
constexpr double kSteep = 0.5;  // minimum |cos β| on the surface ahead
constexpr double kAlong = 0.1;  // minimum |cos β| on the end surface
constexpr int kFew = 3;         // beams in a known cell

/// A surface with its known cells, in coordinates of its plane.
class KnownSurface {
 public:
  KnownSurface(const quality::Surfel& surfel, const quality::Surfels& all, const quality::BeamsView& beams)
      : surfel_(surfel),
        members_(all.beams_of(surfel)),
        weights_(std::span(all.weights).subspan(surfel.begin, members_.size())) {
    Eigen::Vector2d least = Eigen::Vector2d::Constant(std::numeric_limits<double>::infinity());
    Eigen::Vector2d most = -least;
    std::vector<Eigen::Vector2d> feet;
    for (std::size_t k = 0; k < members_.size(); ++k) {
      if (weights_[k] == 0) continue;
      feet.push_back(foot(quality::vector_at(beams.points, members_[k])));
      least = least.cwiseMin(feet.back());
      most = most.cwiseMax(feet.back());
    }
    if (feet.empty()) return;
    // A margin of unknown cells all around, whatever the rounding.
    least_ = least - Eigen::Vector2d::Constant(1.5 * kSide);
    columns_ = along(most.x() - least_.x()) + 2;
    counts_.resize(columns_ * (along(most.y() - least_.y()) + 2));
    for (const auto& at : feet) {
      std::uint16_t& count = counts_[cell(at)];
      count = static_cast<std::uint16_t>(std::min(count + 1, kFew + 1));
    }
  }

  const quality::Surfel& surfel() const { return surfel_; }
  Eigen::Vector2d foot(const Eigen::Vector3d& point) const {
    return {surfel_.u.dot(point - surfel_.middle), surfel_.v.dot(point - surfel_.middle)};
  }
  bool is_known(const Eigen::Vector2d& at) const { return is_on(at) && counts_[cell(at)] >= kFew; }

  /// Whether all cells around are known from beams other than `beam`, which ended at `point`. A beam that
  /// could confirm the surface itself would hide its own large errors.
  bool is_well_inside(const Eigen::Vector2d& at, std::uint32_t beam, const Eigen::Vector3d& point) const {
    if (!is_known(at)) return false;
    const std::size_t middle = cell(at);
    for (const std::size_t row : {middle - columns_, middle, middle + columns_}) {
      for (const std::size_t one : {row - 1, row, row + 1}) {
        if (counts_[one] < kFew) return false;
        if (counts_[one] == kFew && counts(beam) && cell(foot(point)) == one) return false;
      }
    }
    return true;
  }

 private:
  /// Whether the beam is one of those that define the surface.
  bool counts(std::uint32_t beam) const {
    const auto found = std::ranges::lower_bound(members_, beam);
    return found != members_.end() && *found == beam &&
           weights_[static_cast<std::size_t>(found - members_.begin())] > 0;
  }

  static std::size_t along(double length) { return static_cast<std::size_t>(length / kSide); }
  std::size_t cell(const Eigen::Vector2d& at) const {
    return along(at.y() - least_.y()) * columns_ + along(at.x() - least_.x());
  }
  bool is_on(const Eigen::Vector2d& at) const {
    if (counts_.empty() || at.x() < least_.x() || at.y() < least_.y()) return false;
    return along(at.x() - least_.x()) < columns_ && cell(at) < counts_.size();
  }

  quality::Surfel surfel_;
  std::span<const std::uint32_t> members_;  // ascending
  std::span<const double> weights_;         // of the members
  Eigen::Vector2d least_ = Eigen::Vector2d::Zero();
  std::size_t columns_ = 0;
  std::vector<std::uint16_t> counts_;  // beams per cell, saturating at kFew + 1
};

struct Ray {
  Eigen::Vector3d origin;
  Eigen::Vector3d direction;
  Eigen::Vector3d end;
  double range = 0;
};

void follow(const Ray& ray, const std::vector<KnownSurface>& surfaces, std::size_t i,
            BeamAssociation& association) {
  double nearest = std::numeric_limits<double>::infinity();
  double least = std::numeric_limits<double>::infinity();
  for (std::uint32_t s = 0; s < surfaces.size(); ++s) {
    const quality::Surfel& surfel = surfaces[s].surfel();
    const double cosine = -surfel.normal.dot(ray.direction);
    if (cosine < kAlong) continue;
    const double there = surfel.normal.dot(ray.origin - surfel.middle) / cosine;
    const bool may_be_ahead = cosine >= kSteep && there > 0 && there < nearest;
    const bool may_be_end = std::abs(ray.range - there) < least;
    if (!may_be_ahead && !may_be_end) continue;
    const Eigen::Vector2d foot = surfaces[s].foot(ray.origin + there * ray.direction);
    if (may_be_end && surfaces[s].is_known(foot)) {
      least = std::abs(ray.range - there);
      association.end[i] = s;
      association.distance[i] = static_cast<float>(ray.range - there);
      association.end_cosine[i] = static_cast<float>(cosine);
    }
    if (may_be_ahead && surfaces[s].is_well_inside(foot, static_cast<std::uint32_t>(i), ray.end)) {
      nearest = there;
      association.ahead[i] = s;
      association.place[i] = estimate::kPlacesOfEach * s + estimate::place_on(surfel, foot);
      association.error[i] = static_cast<float>(ray.range - there);
      association.cosine[i] = static_cast<float>(cosine);
    }
  }
}

}  // namespace

BeamAssociation associate_beams(const quality::Surfels& surfels, const quality::BeamsView& beams,
                                const std::vector<float>& ranges) {
  constexpr std::size_t kAtOnce = 4096;
  std::vector<KnownSurface> surfaces;
  surfaces.reserve(surfels.surfels.size());
  for (const quality::Surfel& surfel : surfels.surfels) surfaces.emplace_back(surfel, surfels, beams);
  const std::size_t n = ranges.size();
  BeamAssociation association;
  association.ahead.assign(n, kNoSurface);
  association.place.assign(n, 0);
  association.end.assign(n, kNoSurface);
  for (auto* values :
       {&association.error, &association.cosine, &association.distance, &association.end_cosine})
    values->assign(n, 0);
  quality::for_blocks(n, kAtOnce, [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Eigen::Vector3d direction = quality::vector_at(beams.directions, i);
      const double range{ranges[i]};
      const Eigen::Vector3d point = quality::vector_at(beams.points, i);
      follow({.origin = point - range * direction, .direction = direction, .end = point, .range = range},
             surfaces, i, association);
    }
  });
  return association;
}

double usual_error(const BeamAssociation& association) {
  std::vector<float> sizes;
  for (std::size_t i = 0; i < association.size(); ++i) {
    if (association.ahead[i] != kNoSurface) sizes.push_back(std::abs(association.error[i]));
  }
  if (sizes.empty()) return 0;
  return statistics::kMadToSigma * double{statistics::median_in_place(sizes)};
}

}  // namespace crisp::diagnose
