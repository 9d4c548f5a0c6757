// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/estimate/relative_noise.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "pipeline/quality/blocks.hpp"
#include "pipeline/quality/surfel_residuals.hpp"
#include "pipeline/statistics/robust_estimators.hpp"

namespace crisp::estimate {
namespace {

using quality::Surfels;

constexpr std::size_t kMaxPairs = 120'000;
constexpr std::size_t kMinPairs = 1000;  // of a bin: they determine its factor to 4 %
constexpr std::size_t kMaxBins = 12;

/// Two neighbours, the second and the one before it.
struct Pair {
  std::uint32_t before = 0;
  std::uint32_t beam = 0;
  double size = 0;  // [m] of the difference of their residuals along the beam, by √2
};

/// Covariates of each beam's noise.
struct Quantities {
  const std::vector<float>& incidence;
  const std::vector<float>& remission;
  /// [m] To the surface, for those that are on one: by the measured range a beam that noise has made longer
  /// would weigh less than one that it has made shorter, and surfaces would seem nearer than they are.
  std::vector<float> range;
};

/// @param range  is corrected
std::vector<Pair> pairs_on(const quality::Surfel& surfel, const Surfels& surfels,
                           const quality::BeamsView& placed, const Measurements& beams,
                           const quality::SurfelSettings& settings, std::vector<float>& range) {
  std::vector<Pair> pairs;
  const auto members = surfels.beams_of(surfel);
  const auto residuals = quality::residuals_of(surfel, surfels, placed, settings);
  for (std::size_t k = 0; k < members.size(); ++k)
    range[members[k]] += static_cast<float>(residuals[k].range_change);
  for (std::size_t k = 1; k < members.size(); ++k) {
    const std::uint32_t before = members[k - 1];
    const std::uint32_t beam = members[k];
    if (residuals[k].weight == 0 || residuals[k - 1].weight == 0) continue;
    if (!are_neighbours(beams, before, beam)) continue;
    const double difference = residuals[k].range_change - residuals[k - 1].range_change;
    pairs.push_back({.before = before, .beam = beam, .size = std::abs(difference) / std::sqrt(2)});
  }
  return pairs;
}

/// Pairs from all surfaces, evenly thinned, by laser.
///
/// @param range  is corrected
std::vector<std::vector<Pair>> pairs_by_laser(const Surfels& surfels, const quality::BeamsView& placed,
                                              const Measurements& beams,
                                              const quality::SurfelSettings& settings,
                                              std::vector<float>& range) {
  std::vector<std::vector<Pair>> of_surfel(surfels.surfels.size());
  quality::for_each_index(of_surfel.size(), [&](std::size_t s) {
    of_surfel[s] = pairs_on(surfels.surfels[s], surfels, placed, beams, settings, range);
  });
  std::size_t count = 0;
  for (const auto& pairs : of_surfel) count += pairs.size();
  const std::size_t stride = count / kMaxPairs + 1;
  std::vector<std::vector<Pair>> by_laser;
  for (const auto& pairs : of_surfel) {
    for (std::size_t k = 0; k < pairs.size(); k += stride) {
      const std::size_t laser = beams.laser[pairs[k].beam];
      if (by_laser.size() <= laser) by_laser.resize(laser + 1);
      by_laser[laser].push_back(pairs[k]);
    }
  }
  return by_laser;
}

/// A factor that depends on one quantity, in steps.
struct Steps {
  /// Steps of a pair's beams, which may lie on either side of a border.
  struct OfPair {
    std::uint8_t before = 0, beam = 0;
  };

  const std::vector<float>* of = nullptr;  // of each beam
  std::vector<float> ends;                 // of each step but the last, ascending
  std::vector<OfPair> pairs;
  std::vector<double> factor;  // of each step

  std::size_t step(std::uint32_t beam) const {
    return static_cast<std::size_t>(std::ranges::upper_bound(ends, (*of)[beam]) - ends.begin());
  }
  double of_beam(std::uint32_t beam) const { return factor[step(beam)]; }
  double of_pair(std::size_t pair) const {
    const double before = factor[pairs[pair].before];
    const double beam = factor[pairs[pair].beam];
    return std::sqrt((before * before + beam * beam) / 2);
  }
};

/// Steps of equally many pairs, with the factor 1.
Steps even_steps(const std::vector<float>& of, const std::vector<Pair>& pairs) {
  Steps steps{.of = &of, .ends = {}, .pairs = {}, .factor = {}};
  const std::size_t count = std::clamp<std::size_t>(pairs.size() / kMinPairs, 1, kMaxBins);
  std::vector<float> values;
  for (const Pair& pair : pairs) values.push_back(of[pair.beam]);
  std::ranges::sort(values);
  for (std::size_t b = 1; b < count; ++b) {
    const float end = values[b * values.size() / count];
    const float before = steps.ends.empty() ? values.front() : steps.ends.back();
    if (end > before) steps.ends.push_back(end);
  }
  for (const Pair& pair : pairs) {
    steps.pairs.push_back({.before = static_cast<std::uint8_t>(steps.step(pair.before)),
                           .beam = static_cast<std::uint8_t>(steps.step(pair.beam))});
  }
  steps.factor.assign(steps.ends.size() + 1, 1.0);
  return steps;
}

/// Noise factors of one laser.
class OfLaser {
 public:
  OfLaser() = default;
  OfLaser(const std::vector<Pair>& pairs, const Quantities& by) {
    if (pairs.size() < kMinPairs) return;
    for (const auto* of : {&by.range, &by.incidence, &by.remission}) steps_.push_back(even_steps(*of, pairs));
    constexpr int kRounds = 3;  // quantities go with one another, so that one's factor changes another's
    for (int round = 0; round < kRounds; ++round) {
      for (Steps& steps : steps_) fit(steps, pairs);
    }
    std::vector<double> sizes;
    for (std::size_t k = 0; k < pairs.size(); ++k) sizes.push_back(pairs[k].size / of_pair(k));
    size_ = statistics::kMadToSigma * statistics::median_in_place(sizes);
  }

  /// [m] 0 where there are too few neighbours.
  double at(std::uint32_t beam) const {
    double product = 1;
    for (const Steps& steps : steps_) product *= steps.of_beam(beam);
    return size_ * product;
  }

 private:
  double of_pair(std::size_t pair) const {
    double product = 1;
    for (const Steps& steps : steps_) product *= steps.of_pair(pair);
    return product;
  }

  /// Fits the median in each step, conditional on the other quantities' factors.
  void fit(Steps& steps, const std::vector<Pair>& pairs) {
    std::vector<std::vector<double>> sizes(steps.factor.size());
    for (std::size_t k = 0; k < pairs.size(); ++k) {
      sizes[steps.pairs[k].beam].push_back(pairs[k].size / of_pair(k) * steps.of_pair(k));
    }
    for (std::size_t s = 0; s < sizes.size(); ++s) {
      const double middle = sizes[s].empty() ? 0 : statistics::median_in_place(sizes[s]);
      if (middle > 0) steps.factor[s] = statistics::kMadToSigma * middle;
    }
    double mean = 0;
    for (const double factor : steps.factor) mean += factor / static_cast<double>(steps.factor.size());
    for (double& factor : steps.factor) factor /= mean;
  }

  std::vector<Steps> steps_;
  double size_ = 0;
};

/// [m] Standard deviation of each beam's range; 0 where it is unknown.
std::vector<double> noise_by_neighbours(const Surfels& surfels, const quality::BeamsView& placed,
                                        const Measurements& beams, const quality::SurfelSettings& settings) {
  Quantities by{.incidence = beams.cos_incidence, .remission = beams.remission, .range = beams.range};
  constexpr std::size_t kBeamsOfTask = 16'384;
  const auto pairs = pairs_by_laser(surfels, placed, beams, settings, by.range);
  std::vector<OfLaser> lasers(pairs.size());
  quality::for_each_index(lasers.size(),
                          [&](std::size_t laser) { lasers[laser] = OfLaser(pairs[laser], by); });
  std::vector<double> sizes(beams.size(), 0);
  quality::for_blocks(sizes.size(), kBeamsOfTask, [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const std::size_t laser = beams.laser[i];
      if (laser < lasers.size()) sizes[i] = lasers[laser].at(static_cast<std::uint32_t>(i));
    }
  });
  return sizes;
}

/// Sums over beams that count and whose noise is known.
struct NoiseSums {
  double count = 0;
  double squares = 0;  // [m²]
  double inverse = 0;  // [1/m²]

  double usual() const { return count > 0 ? std::sqrt(count / inverse) : 0; }
};

NoiseSums sums_of(const Surfels& surfels, const std::vector<double>& sizes) {
  NoiseSums sums;
  for (std::size_t m = 0; m < surfels.members.size(); ++m) {
    const double size = sizes[surfels.members[m]];
    if (surfels.weights[m] == 0 || size == 0) continue;
    sums.inverse += 1 / (size * size);
    sums.squares += size * size;
    sums.count += 1;
  }
  return sums;
}

}  // namespace

double neighbour_noise(const Surfels& surfels, const quality::BeamsView& placed, const Measurements& beams,
                       const quality::SurfelSettings& settings) {
  return sums_of(surfels, noise_by_neighbours(surfels, placed, beams, settings)).usual();
}

std::vector<float> relative_noise(const Surfels& surfels, const quality::BeamsView& placed,
                                  const Measurements& beams, const quality::SurfelSettings& settings) {
  constexpr double kMinGain = 0.05;
  constexpr double kMax = 4;  // times more or less: beyond, it is what few beams of a step have by chance
  const std::vector<double> sizes = noise_by_neighbours(surfels, placed, beams, settings);
  const NoiseSums sums = sums_of(surfels, sizes);
  // By so much less is the variance of a mean if its values are weighted.
  if (sums.count == 0 || sums.squares * sums.inverse < (1 + kMinGain) * sums.count * sums.count) return {};
  std::vector<float> relative(sizes.size(), 1.0F);
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    if (sizes[i] > 0) relative[i] = static_cast<float>(std::clamp(sizes[i] / sums.usual(), 1 / kMax, kMax));
  }
  return relative;
}

}  // namespace crisp::estimate
