// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/scans/alternation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "pipeline/quality/resampling.hpp"
#include "plugins/scans/profiles_at_rest.hpp"

namespace crisp {
namespace {

constexpr std::size_t kMostLags = 8;
constexpr double kClip = 0.3;          // [m]
constexpr double kStillDiffers = 0.2;  // of the contrast, by scans that are alike
constexpr std::size_t kShuffles = 199;

double mean_difference(const SeriesScan& a, const SeriesScan& b) {
  const auto& p = a.ranges();
  const auto& q = b.ranges();
  double sum = 0;
  std::size_t n = 0;
  for (std::size_t k = 0; k < std::min(p.size(), q.size()); ++k) {
    if (!(p[k] > 0) || !(q[k] > 0)) continue;
    sum += std::min(kClip, std::abs(static_cast<double>(p[k]) - static_cast<double>(q[k])));
    ++n;
  }
  return n > 0 ? sum / static_cast<double>(n) : 0;
}

/// [m] By lag in counts, from 1.
std::vector<double> differences(const std::vector<SeriesScan>& scans,
                                const std::vector<std::int64_t>& counts) {
  std::vector<double> sums(kMostLags, 0);
  std::vector<double> pairs(kMostLags, 0);
  for (std::size_t i = 0; i < scans.size(); ++i) {
    for (std::size_t j = i + 1; j < scans.size(); ++j) {
      const auto lag = std::abs(counts[j] - counts[i]);
      if (lag < 1 || lag > static_cast<std::int64_t>(kMostLags)) continue;
      sums[static_cast<std::size_t>(lag - 1)] += mean_difference(scans[i], scans[j]);
      pairs[static_cast<std::size_t>(lag - 1)] += 1;
    }
  }
  for (std::size_t l = 0; l < kMostLags; ++l) sums[l] = pairs[l] > 0 ? sums[l] / pairs[l] : std::nan("");
  return sums;
}

struct Extremes {
  double least = std::numeric_limits<double>::infinity();
  double most = 0;
  double contrast() const { return most - least; }
};

Extremes extremes(const std::vector<double>& difference) {
  Extremes found;
  for (const double d : difference) {
    if (!std::isfinite(d)) continue;
    found.least = std::min(found.least, d);
    found.most = std::max(found.most, d);
  }
  return found;
}

/// The first number of scans that takes away nearly all of the contrast.
std::size_t period_of(const std::vector<double>& difference) {
  const Extremes range = extremes(difference);
  for (std::size_t l = 0; l < difference.size(); ++l) {
    if (difference[l] - range.least <= kStillDiffers * range.contrast()) return l + 1;
  }
  return 1;
}

/// Puts the counts of each rest into another order: scans of different rests are never compared, and what the
/// actuator's angle changes between them is no turn that kinds of scans take.
void shuffle_within_rests(std::vector<std::int64_t>& counts, const std::vector<std::size_t>& rests,
                          std::mt19937_64& random) {
  for (std::size_t r = 0; r + 1 < rests.size(); ++r) {
    const auto first = counts.begin() + static_cast<std::ptrdiff_t>(rests[r]);
    std::shuffle(first, counts.begin() + static_cast<std::ptrdiff_t>(rests[r + 1]), random);
  }
}

/// Where rests begin, and where the last one ends: more scans lie between them than are compared.
std::vector<std::size_t> rests_of(const std::vector<std::int64_t>& counts) {
  std::vector<std::size_t> first = {0};
  for (std::size_t i = 1; i < counts.size(); ++i) {
    if (counts[i] - counts[i - 1] > static_cast<std::int64_t>(kMostLags)) first.push_back(i);
  }
  first.push_back(counts.size());
  return first;
}

}  // namespace

Alternation find_alternation(const std::vector<SeriesScan>& scans, std::uint64_t seed) {
  constexpr std::size_t kEnough = 400;  // scans; more tell nothing more
  const std::vector<SeriesScan> some(
      scans.begin(), scans.begin() + static_cast<std::ptrdiff_t>(std::min(kEnough, scans.size())));
  std::vector<std::int64_t> counts;
  for (const auto& scan : some) counts.push_back(scan.count);
  Alternation found{.difference = differences(some, counts)};
  found.period = period_of(found.difference);
  if (found.period == 1) return found;
  const double seen = extremes(found.difference).contrast();
  const auto rests = rests_of(counts);
  std::mt19937_64 random(seed);
  std::size_t as_much = 0;
  for (std::size_t i = 0; i < kShuffles; ++i) {
    shuffle_within_rests(counts, rests, random);
    if (extremes(differences(some, counts)).contrast() >= seen) ++as_much;
  }
  found.p_value = static_cast<double>(as_much + 1) / static_cast<double>(kShuffles + 1);
  constexpr double kSure = 0.01;
  if (found.p_value > kSure) found.period = 1;
  return found;
}

std::size_t reference_kind(const std::vector<SeriesScan>& scans, std::size_t period) {
  std::size_t best = 0;
  std::size_t most = 0;
  for (const auto& scan : scans) {
    if (scan.ranges().size() <= most) continue;
    most = scan.ranges().size();
    best = kind_of(scan, period);
  }
  return best;
}

}  // namespace crisp
