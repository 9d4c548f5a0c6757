// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/quality/surfel_end_rejection.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "pipeline/quality/surfel_residuals.hpp"

namespace crisp::quality {
namespace {

/// A part of a surfel: what lies beyond a line across it.
struct End {
  Eigen::Vector2d outwards = Eigen::Vector2d::Zero();
  double from = 0;    ///< [m] along `outwards`, from the surfel's middle
  double chance = 0;  ///< [standard deviations] by which the mean of its residuals is off; 0: there is none

  double along(const SurfelResidual& r) const { return outwards.dot(Eigen::Vector2d(r.u, r.v)); }
};

/// The most significant end in one direction, beyond chance and surface bumps.
End strangest(const std::vector<SurfelResidual>& residuals, const Eigen::Vector2d& outwards) {
  constexpr std::size_t kLines = 64;
  constexpr double kMax = 0.25;    // of the beams
  constexpr double kChance = 4.5;  // standard deviations of a mean: some thousand ends are tested
  constexpr double kBump = 0.3;    // [spreads]
  End end{.outwards = outwards};
  double least = std::numeric_limits<double>::max();
  double most = std::numeric_limits<double>::lowest();
  for (const SurfelResidual& r : residuals) {
    if (r.weight == 0) continue;
    least = std::min(least, end.along(r));
    most = std::max(most, end.along(r));
  }
  if (!(most > least)) return end;
  const double step = (most - least) / kLines;
  std::array<double, kLines> sums{};
  std::array<double, kLines> counts{};
  double all = 0;
  for (const SurfelResidual& r : residuals) {
    if (r.weight == 0) continue;
    const auto line = static_cast<std::size_t>((end.along(r) - least) / step);
    sums[std::min(line, kLines - 1)] += r.distance / r.spread;
    counts[std::min(line, kLines - 1)] += 1;
    all += 1;
  }
  double sum = 0;
  double count = 0;
  for (std::size_t line = kLines; line-- > 0;) {
    sum += sums[line];
    count += counts[line];
    if (count > kMax * all) break;
    const double chance = std::abs(sum) / std::sqrt(std::max(1.0, count));
    if (std::abs(sum) < kBump * count || chance < std::max(kChance, end.chance)) continue;
    end.from = least + step * static_cast<double>(line);
    end.chance = chance;
  }
  return end;
}

}  // namespace

void cut_strange_ends(const Surfel& surfel, Surfels& surfels, const BeamsView& beams,
                      const SurfelSettings& settings) {
  constexpr int kCuts = 6;
  constexpr int kDirections = 16;
  for (int cut = 0; cut < kCuts; ++cut) {
    const auto residuals = residuals_of(surfel, surfels, beams, settings);
    End worst;
    for (int k = 0; k < kDirections; ++k) {
      const double angle = 2 * std::numbers::pi * k / kDirections;
      const End end = strangest(residuals, {std::cos(angle), std::sin(angle)});
      if (end.chance > worst.chance) worst = end;
    }
    if (worst.chance == 0) return;
    for (std::size_t k = 0; k < residuals.size(); ++k) {
      if (worst.along(residuals[k]) >= worst.from) surfels.weights[surfel.begin + k] = 0;
    }
  }
}

}  // namespace crisp::quality
