// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/estimate/agreement.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "pipeline/quality/blocks.hpp"

namespace crisp {
namespace {

constexpr double kLeastShare = 0.5;

/// What one party, a laser or half of its sweep, has of one surfel.
struct Part {
  double beams = 0;
  double sum = 0;  // [m] of their distances from its plane
};

/// The parties' parts of a surfel.
std::vector<Part> parts_of(const Surfel& surfel, const Surfels& surfels, const BeamsView& beams,
                           std::size_t parties, std::uint32_t views_each) {
  std::vector<Part> parts(parties);
  for (std::uint32_t k = surfel.begin; k < surfel.end; ++k) {
    if (surfels.weights[k] <= 0) continue;
    const std::uint32_t beam = surfels.members[k];
    const Eigen::Vector3d point(beams.points.x[beam], beams.points.y[beam], beams.points.z[beam]);
    Part& part = parts[beams.views[beam] / views_each];
    part.beams += 1;
    part.sum += surfel.normal.dot(point - surfel.middle);
  }
  return parts;
}

/// Whether another party meets the surface where this one does.
bool agrees(const std::vector<Part>& parts, std::size_t party, double apart) {
  constexpr double kFew = 5;           // beams whose mean is known to half of the noise
  constexpr double kLeastPart = 0.01;  // of the surfel's beams
  double all = 0;
  for (const Part& part : parts) all += part.beams;
  const double own = parts[party].sum / parts[party].beams;
  for (std::size_t other = 0; other < parts.size(); ++other) {
    const Part& part = parts[other];
    if (other == party || part.beams < std::max(kFew, kLeastPart * all)) continue;
    if (std::abs(part.sum / part.beams - own) < apart) return true;
  }
  return false;
}

}  // namespace

Agreement agreement(const Surfels& surfels, const BeamsView& beams, std::size_t lasers, double noise) {
  constexpr double kApart = 3;  // [σ]
  const bool one_laser = std::ranges::all_of(
      beams.views, [&](std::uint32_t view) { return view / 2 == beams.views.front() / 2; });
  Agreement result{.shares = {}, .by_halves = one_laser};
  const std::size_t parties = result.by_halves ? 2 * lasers : lasers;
  std::vector<double> all(parties, 0);
  std::vector<double> agreed(parties, 0);
  std::vector<std::vector<Part>> of_surfels(surfels.surfels.size());
  for_each_index(of_surfels.size(), [&](std::size_t s) {
    of_surfels[s] = parts_of(surfels.surfels[s], surfels, beams, parties, result.by_halves ? 1 : 2);
  });
  for (const auto& parts : of_surfels) {
    for (std::size_t party = 0; party < parties; ++party) {
      if (parts[party].beams == 0) continue;
      all[party] += parts[party].beams;
      if (agrees(parts, party, kApart * noise)) agreed[party] += parts[party].beams;
    }
  }
  for (std::size_t party = 0; party < parties; ++party) {
    result.shares.push_back(all[party] > 0 ? agreed[party] / all[party] : -1);
  }
  return result;
}

std::vector<std::string> disagreements(const Agreement& agreement, const std::vector<std::string>& lasers) {
  std::vector<std::string> found;
  for (std::size_t party = 0; party < agreement.shares.size(); ++party) {
    const double share = agreement.shares[party];
    if (share < 0 || share >= kLeastShare) continue;
    const std::string who =
        agreement.by_halves ? fmt::format("{} of {}", party % 2 ? "the back" : "the front", lasers[party / 2])
                            : lasers[party];
    found.push_back(fmt::format(
        "only {:.0f} % of what {} sees of flat surfaces is where {} see{} it: the calibration "
        "may have ended in the wrong place",
        100 * share, who, agreement.by_halves ? "the other half" : "others", agreement.by_halves ? "s" : ""));
  }
  return found;
}

}  // namespace crisp
