// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/diagnose/scans/lag_contrast.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "pipeline/statistics/random_stream.hpp"

namespace crisp::diagnose {
namespace {

constexpr double kClip = 0.3;  // [m]
constexpr std::size_t kShuffles = 1999;

double mean_difference(const std::vector<double>& p, const std::vector<double>& q) {
  double sum = 0;
  std::size_t n = 0;
  for (std::size_t k = 0; k < std::min(p.size(), q.size()); ++k) {
    const double size = std::abs(p[k] - q[k]);
    if (!(size >= 0)) continue;
    sum += std::min(kClip, size);
    ++n;
  }
  return n > 0 ? sum / static_cast<double>(n) : 0;
}

std::vector<std::size_t> rests_of(const std::vector<std::int64_t>& counts) {
  std::vector<std::size_t> first = {0};
  for (std::size_t i = 1; i < counts.size(); ++i) {
    if (counts[i] - counts[i - 1] > static_cast<std::int64_t>(kMaxLags)) first.push_back(i);
  }
  first.push_back(counts.size());
  return first;
}

}  // namespace

double contrast_of(const std::vector<double>& by_lag) {
  double least = std::numeric_limits<double>::infinity();
  double most = -least;
  for (const double value : by_lag) {
    if (!std::isfinite(value)) continue;
    least = std::min(least, value);
    most = std::max(most, value);
  }
  return most > least ? most - least : 0;
}

LagContrast::LagContrast(std::vector<std::vector<double>> rows, const std::vector<std::int64_t>& counts)
    : rows_(std::move(rows)), phases_(rests_of(counts)) {
  for (std::size_t r = 0; r + 1 < phases_.size(); ++r) {
    for (std::size_t i = phases_[r]; i < phases_[r + 1]; ++i) {
      for (std::size_t j = i + 1; j < phases_[r + 1]; ++j) {
        const auto lag = static_cast<std::size_t>(counts[j] - counts[i]);
        if (lag >= 1 && lag <= kMaxLags) pairs_.push_back({.first = i, .second = j, .lag = lag});
      }
    }
  }
  difference_ = by_lag([&](std::size_t i, std::size_t j) { return mean_difference(rows_[i], rows_[j]); });
}

double LagContrast::contrast() const { return contrast_of(difference_); }

template <class Between>
std::vector<double> LagContrast::by_lag(const Between& between) const {
  std::vector<double> sums(kMaxLags, 0);
  std::vector<double> counts(kMaxLags, 0);
  for (const Pair& pair : pairs_) {
    sums[pair.lag - 1] += between(pair.first, pair.second);
    counts[pair.lag - 1] += 1;
  }
  for (std::size_t l = 0; l < kMaxLags; ++l) sums[l] = counts[l] > 0 ? sums[l] / counts[l] : std::nan("");
  return sums;
}

/// [m] Mean absolute differences of all pairs of scans within a stationary phase.
std::vector<double> LagContrast::matrix() const {
  std::vector<double> all(rows_.size() * rows_.size(), 0);
  for (std::size_t r = 0; r + 1 < phases_.size(); ++r) {
    for (std::size_t i = phases_[r]; i < phases_[r + 1]; ++i) {
      for (std::size_t j = i + 1; j < phases_[r + 1]; ++j) {
        all[i * rows_.size() + j] = all[j * rows_.size() + i] = mean_difference(rows_[i], rows_[j]);
      }
    }
  }
  return all;
}

/// Groups of exchangeable scans.
std::vector<std::vector<std::size_t>> LagContrast::groups(const std::vector<std::size_t>& kinds) const {
  std::map<std::pair<std::size_t, std::size_t>, std::vector<std::size_t>> by_phase_and_class;
  for (std::size_t r = 0; r + 1 < phases_.size(); ++r) {
    for (std::size_t i = phases_[r]; i < phases_[r + 1]; ++i) {
      by_phase_and_class[{r, kinds.empty() ? 0 : kinds[i]}].push_back(i);
    }
  }
  std::vector<std::vector<std::size_t>> all;
  for (auto& [key, scans] : by_phase_and_class) all.push_back(std::move(scans));
  return all;
}

statistics::MonteCarloTest LagContrast::permutation_test(std::uint64_t seed,
                                                         const std::vector<std::size_t>& kinds) const {
  const std::vector<double> between = matrix();
  const auto alike = groups(kinds);
  statistics::RandomStream random(seed, "lags");
  std::vector<std::size_t> order(rows_.size());
  return statistics::monte_carlo_test(contrast(), kShuffles, [&] {
    for (const auto& places : alike) {
      auto scans = places;
      random.shuffle(scans);
      for (std::size_t k = 0; k < places.size(); ++k) order[places[k]] = scans[k];
    }
    return contrast_of(
        by_lag([&](std::size_t i, std::size_t j) { return between[order[i] * order.size() + order[j]]; }));
  });
}

}  // namespace crisp::diagnose
