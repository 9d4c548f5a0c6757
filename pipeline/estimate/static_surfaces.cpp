// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/estimate/static_surfaces.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

#include "pipeline/quality/blocks.hpp"
#include "pipeline/quality/vector_at.hpp"
#include "pipeline/statistics/robust_estimators.hpp"

namespace crisp::estimate {
namespace {

/// Spread of a surfel's views.
struct Spread {
  double weight = 0;     // of its beams
  double squares = 0;    // [m²] mean square over them
  double by_chance = 0;  // [σ²] what of that the noise of ranges makes
};
Spread spread_of_views(const quality::Surfel& surfel, const quality::Surfels& surfels,
                       const quality::BeamsView& beams, std::size_t views) {
  struct View {
    double weight = 0;
    double sum = 0;
  };
  std::vector<View> parts(views);
  View all;
  for (std::uint32_t k = surfel.begin; k < surfel.end; ++k) {
    const std::uint32_t beam = surfels.members[k];
    const Eigen::Vector3d point = quality::vector_at(beams.points, beam);
    const double weight = surfels.weights[k];
    const double moment = weight * surfel.normal.dot(point - surfel.middle);
    View& own = parts[beams.views[beam]];
    own.weight += weight;
    own.sum += moment;
    all.weight += weight;
    all.sum += moment;
  }
  if (!(all.weight > 0)) return {};
  Spread spread{.weight = all.weight, .squares = 0, .by_chance = -1 / all.weight};
  for (const View& view : parts) {
    if (!(view.weight > 0)) continue;
    spread.squares += view.weight * std::pow(view.sum / view.weight - all.sum / all.weight, 2) / all.weight;
    spread.by_chance += 1 / all.weight;
  }
  return spread;
}

/// [m] How far apart views lie where few beams are on surfels whose views lie farther apart still.
double far_for_most_beams(std::vector<Spread> spreads) {
  constexpr double kFew = 0.1;
  double few = 0;
  for (const Spread& spread : spreads) few += kFew * spread.weight;
  std::ranges::sort(spreads, std::greater(), &Spread::squares);
  for (const Spread& spread : spreads) {
    few -= spread.weight;
    if (few < 0) return std::sqrt(spread.squares);
  }
  return 0;
}

}  // namespace

std::vector<bool> static_surfaces(const quality::Surfels& surfels, const quality::BeamsView& beams,
                                  double noise) {
  constexpr double kMuchMore = 5;
  constexpr double kMin = 0.25;  // [σ]
  constexpr double kChance = 4;  // of what is expected by chance: χ² of five is beyond once in a thousand
  if (surfels.surfels.empty() || beams.views.empty()) return std::vector<bool>(surfels.surfels.size(), true);
  const std::size_t views = *std::ranges::max_element(beams.views) + 1;
  std::vector<Spread> spreads(surfels.surfels.size());
  quality::for_each_index(spreads.size(), [&](std::size_t s) {
    spreads[s] = spread_of_views(surfels.surfels[s], surfels, beams, views);
  });
  std::vector<double> sizes;
  for (const Spread& spread : spreads) sizes.push_back(std::sqrt(spread.squares));
  const double most =
      std::max({kMin * noise, kMuchMore * statistics::median_in_place(sizes), far_for_most_beams(spreads)});
  std::vector<bool> result;
  for (const Spread& spread : spreads) {
    result.push_back(spread.squares <= most * most + kChance * noise * noise * spread.by_chance);
  }
  return result;
}

quality::Surfels kept(const quality::Surfels& surfels, const std::vector<bool>& keep) {
  quality::Surfels result{.surfels = {}, .members = surfels.members, .weights = surfels.weights};
  for (std::size_t k = 0; k < surfels.surfels.size(); ++k) {
    if (keep[k]) result.surfels.push_back(surfels.surfels[k]);
  }
  return result;
}

}  // namespace crisp::estimate
