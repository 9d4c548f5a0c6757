// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/quality/surfels.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>

#include <crisp/error.hpp>

#include "pipeline/quality/blocks.hpp"
#include "pipeline/quality/surfel_patches.hpp"
#include "pipeline/quality/surfel_residuals.hpp"
#include "pipeline/quality/vector_at.hpp"

namespace crisp::quality {
namespace {

void check(const BeamsView& beams, const SurfelSettings& settings) {
  check(beams.points);
  check(beams.directions);
  const std::size_t n = beams.points.size();
  if (beams.directions.size() != n || !(beams.views.empty() || beams.views.size() == n)) {
    throw Error(fmt::format("there are {} points, {} directions and {} views", n, beams.directions.size(),
                            beams.views.size()),
                "give one of each a beam, or no views at all");
  }
  if (!(settings.smallest > 0 && settings.largest >= settings.smallest && settings.noise > 0 &&
        settings.floor > 0 && settings.max_thickness > 0 && settings.min_points >= 4)) {
    throw Error("the settings of surfels are out of range",
                "0 < smallest <= largest, noise, floor and max_thickness > 0, min_points >= 4");
  }
}

/// The beams of each region, one region after the other.
void sort_members(const std::vector<std::uint32_t>& region_of, Surfels& result) {
  for (const std::uint32_t r : region_of) {
    if (r != kNoRegion) ++result.surfels[r].end;
  }
  std::uint32_t total = 0;
  for (Surfel& surfel : result.surfels) {
    surfel.begin = total;
    total += surfel.end;
    surfel.end = surfel.begin;
  }
  result.members.resize(total);
  result.weights.assign(total, 1);
  for (std::uint32_t i = 0; i < region_of.size(); ++i) {
    if (region_of[i] != kNoRegion) result.members[result.surfels[region_of[i]].end++] = i;
  }
}

/// Sets the surfel's plane to that of its beams.
void set_plane(Surfel& surfel, std::span<const std::uint32_t> members, const BeamsView& beams,
               const SurfelCells& cells) {
  Moments moments;
  Eigen::Vector3d towards = Eigen::Vector3d::Zero();
  for (const std::uint32_t beam : members) {
    moments.add(cells.point(beams, beam));
    towards -= vector_at(beams.directions, beam);
  }
  const Plane plane = plane_of(moments);
  surfel.middle = plane.middle + cells.origin;
  surfel.normal = plane.normal.dot(towards) < 0 ? Eigen::Vector3d(-plane.normal) : plane.normal;
  surfel.u = plane.u;
  surfel.v = surfel.normal.cross(plane.u);
  surfel.radius = std::hypot(plane.extent[1], plane.extent[2]);
  surfel.thickness = plane.extent[0];
}

/// RMS of a surfel's residuals, in units of their spread.
double misfit(const Surfel& surfel, const Surfels& surfels, const BeamsView& beams,
              const SurfelSettings& settings) {
  double sum = 0;
  double weight = 0;
  for (const SurfelResidual& r : residuals_of(surfel, surfels, beams, settings)) {
    sum += r.weight * std::pow(r.distance / r.spread, 2);
    weight += r.weight;
  }
  return std::sqrt(sum / std::max(weight, 1.0));
}

/// Mean |cosine| between the beams that count and the normal; 0 if none counts.
double incidence_of(const Surfel& surfel, const Surfels& surfels, const BeamsView& beams) {
  double sum = 0;
  double weights = 0;
  for (std::uint32_t k = surfel.begin; k < surfel.end; ++k) {
    sum += surfels.weights[k] * std::abs(surfel.normal.dot(vector_at(beams.directions, surfels.members[k])));
    weights += surfels.weights[k];
  }
  return weights > 0 ? sum / weights : 0;
}

}  // namespace

void Surfels::add(Surfel surfel, std::span<const std::uint32_t> beams) {
  surfel.begin = static_cast<std::uint32_t>(members.size());
  members.insert(members.end(), beams.begin(), beams.end());
  surfel.end = static_cast<std::uint32_t>(members.size());
  weights.resize(members.size(), 1);
  surfels.push_back(std::move(surfel));
}

Surfels thinned(const Surfels& surfels, std::size_t most) {
  std::size_t all = 0;
  for (const Surfel& surfel : surfels.surfels) all += surfel.end - surfel.begin;
  const std::size_t stride = std::max<std::size_t>(1, (all + most - 1) / most);
  Surfels some;
  for (Surfel surfel : surfels.surfels) {
    const auto begin = static_cast<std::uint32_t>(some.members.size());
    for (std::size_t k = surfel.begin; k < surfel.end; k += stride) {
      some.members.push_back(surfels.members[k]);
      some.weights.push_back(surfels.weights[k]);
    }
    surfel.begin = begin;
    surfel.end = static_cast<std::uint32_t>(some.members.size());
    some.surfels.push_back(surfel);
  }
  return some;
}

Surfels find_surfels(const BeamsView& beams, const SurfelSettings& settings) {
  check(beams, settings);
  const SurfelCells cells = cells_of(beams, settings);
  const auto pieces = flat_patches(beams, cells, settings);
  const auto regions = joined(pieces, beams, cells, settings);
  Surfels result;
  result.surfels.resize(regions.size());
  sort_members(region_of_beams(beams, cells, pieces, regions, settings), result);
  std::erase_if(result.surfels,
                [&](const Surfel& surfel) { return surfel.end - surfel.begin < settings.min_points; });
  for_each_index(result.surfels.size(), [&](std::size_t s) {
    Surfel& surfel = result.surfels[s];
    set_plane(surfel, result.beams_of(surfel), beams, cells);
    refine(surfel, result, beams, settings);
  });
  // Where each view is but a line, an edge resembles lines that disagree.
  constexpr double kFarMore = 3;
  reject_inconsistent(result, beams, settings, kFarMore);
  std::ranges::stable_sort(result.surfels, std::ranges::greater{},
                           [](const Surfel& surfel) { return surfel.end - surfel.begin; });
  return result;
}

void reject_inconsistent(Surfels& found, const BeamsView& beams, const SurfelSettings& settings,
                         double times) {
  constexpr double kChance = 2.1;  // 3 standard deviations of n beams' root mean square, times √n
  std::vector<double> misfits(found.surfels.size());
  for_each_index(misfits.size(),
                 [&](std::size_t s) { misfits[s] = misfit(found.surfels[s], found, beams, settings); });
  std::vector<std::pair<double, std::uint32_t>> sorted;
  std::uint64_t all = 0;
  for (std::size_t s = 0; s < misfits.size(); ++s) {
    const std::uint32_t count = found.surfels[s].end - found.surfels[s].begin;
    sorted.emplace_back(misfits[s], count);
    all += count;
  }
  std::ranges::sort(sorted);
  double median = 0;  // of the beams' surfels
  std::uint64_t below = 0;
  for (auto next = sorted.begin(); next != sorted.end() && 2 * below <= all; ++next) {
    median = next->first;
    below += next->second;
  }
  std::vector<Surfel> kept;
  for (std::size_t s = 0; s < misfits.size(); ++s) {
    const Surfel& surfel = found.surfels[s];
    const double chance = kChance / std::sqrt(std::max(1U, surfel.end - surfel.begin));
    if (misfits[s] <= (times + chance) * std::max(median, 1.0)) kept.push_back(surfel);
  }
  found.surfels = std::move(kept);
}

void reject_grazed(Surfels& found, const BeamsView& beams) {
  constexpr double kLeast = 0.2;
  std::erase_if(found.surfels,
                [&](const Surfel& surfel) { return incidence_of(surfel, found, beams) < kLeast; });
}

}  // namespace crisp::quality
