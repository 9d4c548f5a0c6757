// SPDX-License-Identifier: BSD-3-Clause
#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "pipeline/quality/blocks.hpp"
#include "pipeline/quality/sort_unique.hpp"
#include "pipeline/quality/surfel_patches.hpp"
#include "pipeline/quality/vector_at.hpp"
#include "pipeline/quality/view_flatness.hpp"
#include "pipeline/quality/view_planes.hpp"

namespace crisp::quality {
namespace {

constexpr double kEdge = 0.95;  // cosine of the angle from which on two surfaces meet at an edge
constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();

std::vector<std::size_t> patch_of_cells(const std::vector<FlatPatch>& patches, const SurfelCells& cells) {
  std::vector<std::size_t> result(cells.size(), kNone);
  for (std::size_t p = 0; p < patches.size(); ++p) {
    std::fill(result.begin() + static_cast<std::ptrdiff_t>(patches[p].first_cell),
              result.begin() + static_cast<std::ptrdiff_t>(patches[p].last_cell), p);
  }
  return result;
}

/// Which pieces touch which.
std::vector<std::vector<std::size_t>> contacts(const std::vector<FlatPatch>& patches,
                                               const SurfelCells& cells) {
  const auto patch_of = patch_of_cells(patches, cells);
  const CellFinder finder(cells);
  std::vector<std::vector<std::size_t>> result(patches.size());
  for (std::size_t c = 0; c < cells.size(); ++c) {
    if (patch_of[c] == kNone) continue;
    for (const std::size_t other : finder.around(c)) {
      if (patch_of[other] != kNone && patch_of[other] != patch_of[c])
        result[patch_of[c]].push_back(patch_of[other]);
    }
  }
  for (auto& list : result) {
    sort_once(list);
  }
  return result;
}

/// How well a piece knows its own direction [rad].
double tilt_error(const FlatPatch& patch, const SurfelSettings& settings) {
  return settings.noise / (std::sqrt(patch.moments.count) * patch.plane.extent[1]);
}

/// Whether a piece lies in the plane of a region: its middle near it, its direction alike.
bool keeps_to(const Plane& plane, const FlatPatch& patch, const SurfelSettings& settings) {
  const double tilt = std::acos(std::min(1.0, std::abs(plane.normal.dot(patch.plane.normal))));
  return tilt <= settings.max_tilt + 3 * tilt_error(patch, settings) &&
         std::abs(plane.distance(patch.plane.middle)) <= settings.max_offset;
}

/// The planes in which views see each piece; none where they are not compared.
std::vector<ViewPlanes> view_planes(const std::vector<FlatPatch>& patches, const BeamsView& beams,
                                    const SurfelCells& cells, const SurfelSettings& settings) {
  std::vector<ViewPlanes> result(patches.size());
  if (!std::isfinite(settings.max_bump)) return result;
  const ViewNumbers views(beams);
  for_each_index(patches.size(), [&](std::size_t p) {
    const FlatPatch& patch = patches[p];
    for (std::uint32_t k = cells.begin[patch.first_cell]; k < cells.begin[patch.last_cell]; ++k) {
      const std::uint32_t i = cells.order.index[k];
      const Eigen::Vector3d direction = vector_at(beams.directions, i);
      const double across = settings.noise * patch.plane.normal.dot(direction);
      result[p].add(views.of_beam[i], cells.point(beams, i),
                    1 / (across * across + settings.floor * settings.floor));
    }
  });
  return result;
}

/// Assigns beams to regions.
class BeamSorter {
 public:
  BeamSorter(const SurfelCells& cells, const std::vector<FlatPatch>& patches,
             const std::vector<FlatRegion>& regions, const SurfelSettings& settings)
      : cells_(cells), regions_(regions), finder_(cells), region_of_cell_(cells.size(), kNoRegion) {
    for (std::uint32_t r = 0; r < regions.size(); ++r) {
      gate_.push_back(5 * std::max(regions[r].plane.extent[0], settings.noise));
      for (const std::size_t p : regions[r].patches) {
        for (std::size_t c = patches[p].first_cell; c < patches[p].last_cell; ++c) region_of_cell_[c] = r;
      }
    }
  }

  /// The regions that have cells among the 27 about this one.
  std::vector<std::uint32_t> regions_around(std::size_t cell) const {
    std::vector<std::uint32_t> near;
    for (const std::size_t other : finder_.around(cell)) {
      if (region_of_cell_[other] != kNoRegion) near.push_back(region_of_cell_[other]);
    }
    sort_once(near);
    return near;
  }

  /// @param cell  in which the beam ends
  std::uint32_t region_of(const Eigen::Vector3d& point, const Eigen::Vector3d& direction, std::size_t cell,
                          const std::vector<std::uint32_t>& near) const {
    for (const std::uint32_t r : near) {
      const Plane& plane = regions_[r].plane;
      const double distance = plane.distance(point);
      const double incidence = plane.normal.dot(direction);
      if (std::abs(distance) > gate_[r] || std::abs(incidence) < 0.05) continue;
      // A beam's intersection with the plane does not depend on the noise of its range, and nor may the
      // choice: otherwise beams that are too short would be preferred to those that are too long.
      const Eigen::Vector3d foot = point - distance / incidence * direction;
      if (region_at(foot, cell) == r && !is_near_another(foot, r, near)) return r;
    }
    return kNoRegion;
  }

 private:
  /// @param guess  at the cell
  std::uint32_t region_at(const Eigen::Vector3d& point, std::size_t guess) const {
    const Eigen::Vector3d at = point + cells_.origin;
    const std::uint64_t key = cell_key(cells_.order.lattice.cell(at.x(), at.y(), at.z()));
    const std::size_t cell = key == cells_.key[guess] ? guess : finder_.find(key);
    return cell == cells_.size() ? kNoRegion : region_of_cell_[cell];
  }

  /// At an edge between two surfaces, each would get beams of the other, all on the same side.
  bool is_near_another(const Eigen::Vector3d& foot, std::uint32_t own,
                       const std::vector<std::uint32_t>& near) const {
    return std::ranges::any_of(near, [&](std::uint32_t r) {
      return r != own && std::abs(regions_[r].plane.distance(foot)) < gate_[r] &&
             std::abs(regions_[r].plane.normal.dot(regions_[own].plane.normal)) < kEdge;
    });
  }

  const SurfelCells& cells_;
  const std::vector<FlatRegion>& regions_;
  CellFinder finder_;
  std::vector<std::uint32_t> region_of_cell_;
  std::vector<double> gate_;  // [m] within which beams may end
};

}  // namespace

std::vector<FlatRegion> joined(const std::vector<FlatPatch>& patches, const BeamsView& beams,
                               const SurfelCells& cells, const SurfelSettings& settings) {
  const auto touching = contacts(patches, cells);
  const auto planes = view_planes(patches, beams, cells, settings);
  std::vector<std::size_t> by_count(patches.size());
  std::iota(by_count.begin(), by_count.end(), std::size_t{0});
  std::ranges::stable_sort(by_count, std::ranges::greater{},
                           [&](std::size_t p) { return patches[p].moments.count; });
  std::vector<bool> taken(patches.size(), false);
  std::vector<FlatRegion> regions;
  for (const std::size_t seed : by_count) {
    if (taken[seed]) continue;
    FlatRegion region{{seed}, patches[seed].moments, patches[seed].plane};
    ViewPlanes seen = planes[seed];
    taken[seed] = true;
    for (std::size_t k = 0; k < region.patches.size(); ++k) {
      for (const std::size_t other : touching[region.patches[k]]) {
        if (taken[other] || !keeps_to(region.plane, patches[other], settings)) continue;
        if (!seen.continues(planes[other], region.plane, settings.max_bump)) continue;
        taken[other] = true;
        region.patches.push_back(other);
        region.moments += patches[other].moments;
        region.plane = plane_of(region.moments);
        seen += planes[other];
      }
    }
    regions.push_back(std::move(region));
  }
  return regions;
}

std::vector<std::uint32_t> region_of_beams(const BeamsView& beams, const SurfelCells& cells,
                                           const std::vector<FlatPatch>& patches,
                                           const std::vector<FlatRegion>& regions,
                                           const SurfelSettings& settings) {
  const BeamSorter sorter(cells, patches, regions, settings);
  std::vector<std::uint32_t> result(beams.points.size(), kNoRegion);
  for_each_index(cells.size(), [&](std::size_t c) {
    const auto near = sorter.regions_around(c);
    if (near.empty()) return;
    for (std::uint32_t k = cells.begin[c]; k < cells.begin[c + 1]; ++k) {
      const std::uint32_t i = cells.order.index[k];
      const Eigen::Vector3d direction = vector_at(beams.directions, i);
      result[i] = sorter.region_of(cells.point(beams, i), direction, c, near);
    }
  });
  return result;
}

}  // namespace crisp::quality
