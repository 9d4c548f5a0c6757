// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/estimate/surface_association.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <span>

#include "pipeline/quality/blocks.hpp"
#include "pipeline/quality/vector_at.hpp"

namespace crisp::estimate {
namespace {

using quality::BeamsView;
using quality::Surfels;
using quality::SurfelSettings;

constexpr std::uint32_t kNone = ~std::uint32_t{0};
constexpr double kGrazing = 0.05;  // as where surfels are fitted

/// A surfel with its borders: the box around its beams in (u, v) [m], from its middle.
class Claimant {
 public:
  Claimant(const quality::Surfel& surfel, const Surfels& surfels, const BeamsView& beams) : surfel_(surfel) {
    for (const std::uint32_t i : surfels.beams_of(surfel)) take(quality::vector_at(beams.points, i));
  }

  void take(const Eigen::Vector3d& end) {
    box_.extend(in_plane(end - surfel_.middle));
    beams_ += 1;
  }

  /// Distance beyond the borders up to which beams are associated [m].
  double reach(const AssociationSettings& associations) const {
    return std::max(associations.margin, associations.spacings * std::sqrt(box_.volume() / beams_));
  }

  /// The range change that puts a beam's end on the plane [m], and the distance beyond the surface's borders
  /// [m].
  struct Meeting {
    double range_change = 0;
    double beyond = 0;
  };
  /// Nothing if the beam does not end near the plane.
  std::optional<Meeting> meeting(const Eigen::Vector3d& end, const Eigen::Vector3d& direction,
                                 const SurfelSettings& settings,
                                 const AssociationSettings& associations) const {
    const double incidence = surfel_.normal.dot(direction);
    const double distance = surfel_.normal.dot(end - surfel_.middle);
    const double spread = std::max(settings.noise * std::abs(incidence), surfel_.thickness);
    if (std::abs(incidence) < kGrazing || std::abs(distance) > associations.gate * spread)
      return std::nullopt;
    const Eigen::Vector3d foot = end - distance / incidence * direction;
    return Meeting{-distance / incidence, box_.exteriorDistance(in_plane(foot - surfel_.middle))};
  }

  /// Whether there may be a meeting within reach for any beam that ends in the box.
  bool may_associate_in(const Eigen::AlignedBox3d& ends, const SurfelSettings& settings,
                        const AssociationSettings& associations) const {
    const double across = associations.gate * std::max(settings.noise, surfel_.thickness);
    if (!is_hit(ends, surfel_.normal, -across, across)) return false;
    const double slide = associations.gate * std::max(settings.noise, surfel_.thickness / kGrazing);
    const double beyond = reach(associations) + slide;
    return is_hit(ends, surfel_.u, box_.min().x() - beyond, box_.max().x() + beyond) &&
           is_hit(ends, surfel_.v, box_.min().y() - beyond, box_.max().y() + beyond);
  }

  /// Whether they are pieces of one plane.
  bool continues(const Claimant& other) const {
    constexpr double kParallel = 0.99;  // cosine of 8°
    return std::abs(surfel_.normal.dot(other.surfel_.normal)) > kParallel;
  }

  /// Whether the other surface is on the lasers' side of this one: a concave corner.
  bool is_hollow_with(const Claimant& other) const {
    return surfel_.normal.dot(other.surfel_.middle - surfel_.middle) > 0;
  }

 private:
  /// Whether any point of the box is from `low` to `high` along the axis [m], from the surfel's middle.
  bool is_hit(const Eigen::AlignedBox3d& ends, const Eigen::Vector3d& axis, double low, double high) const {
    const double middle = axis.dot(ends.center() - surfel_.middle);
    const double half = axis.cwiseAbs().dot(ends.sizes()) / 2;
    return middle + half >= low && middle - half <= high;
  }

  Eigen::Vector2d in_plane(const Eigen::Vector3d& offset) const {
    return {surfel_.u.dot(offset), surfel_.v.dot(offset)};
  }

  const quality::Surfel& surfel_;
  Eigen::AlignedBox2d box_;
  double beams_ = 0;
};

/// The surface that the beam met. Where it might be either of two it is decided by where the beam meets their
/// planes, not by where its noise has put its end: that would tilt the planes. A beam into a corner ends on
/// the plane that it meets first; one onto an edge on the one that it meets last.
///
/// @param near  those of the claimants that may have met it
std::uint32_t owner(const std::vector<Claimant>& claimants, const std::vector<std::uint32_t>& near,
                    const BeamsView& beams, std::uint32_t beam, const SurfelSettings& settings,
                    const AssociationSettings& associations) {
  std::uint32_t best = kNone;
  Claimant::Meeting least;
  for (const std::uint32_t s : near) {
    const auto hit = claimants[s].meeting(quality::vector_at(beams.points, beam),
                                          quality::vector_at(beams.directions, beam), settings, associations);
    if (!hit || hit->beyond > claimants[s].reach(associations)) continue;
    const auto is_better = [&] {
      if (best == kNone) return true;
      if (claimants[s].continues(claimants[best])) return hit->beyond < least.beyond;
      return claimants[s].is_hollow_with(claimants[best]) == (hit->range_change < least.range_change);
    };
    if (!is_better()) continue;
    best = s;
    least = *hit;
  }
  return best;
}

/// The claimants that may have met any of `some` beams.
std::vector<std::uint32_t> near_any(const std::vector<Claimant>& claimants, const BeamsView& beams,
                                    std::span<const std::uint32_t> some, const SurfelSettings& settings,
                                    const AssociationSettings& associations) {
  Eigen::AlignedBox3d ends;
  for (const std::uint32_t beam : some) ends.extend(quality::vector_at(beams.points, beam));
  std::vector<std::uint32_t> near;
  for (std::uint32_t s = 0; s < claimants.size(); ++s) {
    if (claimants[s].may_associate_in(ends, settings, associations)) near.push_back(s);
  }
  return near;
}

/// The owner of each of `some` beams, or kNone.
std::vector<std::uint32_t> owners(const std::vector<Claimant>& claimants, const BeamsView& beams,
                                  std::span<const std::uint32_t> some, const SurfelSettings& settings,
                                  const AssociationSettings& associations) {
  constexpr std::size_t kBlock =
      32;  // beams that were fired one after the other, and so end near one another
  std::vector<std::uint32_t> result(some.size());
  quality::for_blocks(some.size(), kBlock, [&](std::size_t, std::size_t begin, std::size_t end) {
    const auto near = near_any(claimants, beams, some.subspan(begin, end - begin), settings, associations);
    for (std::size_t k = begin; k < end; ++k) {
      result[k] = owner(claimants, near, beams, some[k], settings, associations);
    }
  });
  return result;
}

std::vector<Claimant> claimants_of(const Surfels& surfels, const BeamsView& beams) {
  std::vector<Claimant> claimants;
  for (const quality::Surfel& surfel : surfels.surfels) claimants.emplace_back(surfel, surfels, beams);
  return claimants;
}

/// The surfels that own enough of the beams, with what they own.
Surfels sorted_by_owner(const std::vector<quality::Surfel>& surfels,
                        const std::vector<std::uint32_t>& owner_of, const SurfelSettings& settings) {
  std::vector<std::vector<std::uint32_t>> members(surfels.size());
  for (std::uint32_t i = 0; i < owner_of.size(); ++i) {
    if (owner_of[i] != kNone) members[owner_of[i]].push_back(i);
  }
  Surfels result;
  for (std::size_t s = 0; s < surfels.size(); ++s) {
    if (members[s].size() < settings.min_points) continue;
    result.add(surfels[s], members[s]);
  }
  return result;
}

}  // namespace

Surfels associate_with_surfaces(const Surfels& found, const BeamsView& beams, const SurfelSettings& settings,
                                const AssociationSettings& associations) {
  std::vector<std::uint32_t> all(beams.points.size());
  std::iota(all.begin(), all.end(), 0U);
  return sorted_by_owner(found.surfels,
                         owners(claimants_of(found, beams), beams, all, settings, associations), settings);
}

Surfels grow_surfaces(const Surfels& surfels, const BeamsView& beams, const SurfelSettings& settings,
                      const AssociationSettings& associations) {
  std::vector<std::uint32_t> owner_of(beams.points.size(), kNone);
  for (std::uint32_t s = 0; s < surfels.surfels.size(); ++s) {
    for (const std::uint32_t i : surfels.beams_of(surfels.surfels[s])) owner_of[i] = s;
  }
  auto claimants = claimants_of(surfels, beams);
  std::size_t before = 0;
  std::vector<std::uint32_t> left;
  do {
    before = left.size();
    left.clear();
    for (std::uint32_t i = 0; i < owner_of.size(); ++i) {
      if (owner_of[i] == kNone) left.push_back(i);
    }
    const auto takers = owners(claimants, beams, left, settings, associations);
    for (std::size_t k = 0; k < left.size(); ++k) {
      if (takers[k] == kNone) continue;
      owner_of[left[k]] = takers[k];
      claimants[takers[k]].take(quality::vector_at(beams.points, left[k]));
    }
  } while (left.size() != before);
  return sorted_by_owner(surfels.surfels, owner_of, settings);
}

}  // namespace crisp::estimate
