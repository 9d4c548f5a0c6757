// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/scans/told_at_rest.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <span>

#include "pipeline/data/least_chance.hpp"
#include "pipeline/data/robust.hpp"
#include "plugins/scans/lag_contrast.hpp"
#include "plugins/scans/profiles_at_rest.hpp"

namespace crisp {
namespace {

using Row = std::vector<double>;

constexpr double kLargestRestError = 0.1;  // [m] between profiles; more counts as that
constexpr std::size_t kFewestOfAKind = 4;  // scans in half of a rest
constexpr std::size_t kFewestBeams = 20;   // of all rests
constexpr std::size_t kSimulations = 499;

/// The scans of one rest, of which the first half is fitted to.
struct Rest {
  std::vector<Row> rows;
  std::vector<std::size_t> kinds;
  std::vector<std::int64_t> counts;
  std::vector<std::size_t> beams = {};  ///< that count

  bool is_fitted(std::size_t i) const { return 2 * i < rows.size(); }
  std::vector<Row> of(std::size_t kind, bool fitted) const {
    std::vector<Row> some;
    for (std::size_t i = 0; i < rows.size(); ++i) {
      if (kinds[i] == kind && is_fitted(i) == fitted) some.push_back(rows[i]);
    }
    return some;
  }
};

/// What an interleave foretells.
struct Interleave {
  std::vector<double> shifts;   ///< [beams] by kind
  std::vector<Row> references;  ///< [m] by rest: the profile that all kinds are of
};

/// A range between two beams of a profile where the surface goes straight from the one spot to the other: on
/// a line the inverse of the range is nearly even in the angle.
double straight_at(const Row& profile, double beam) {
  const double floor = std::floor(beam);
  if (floor < 0 || floor + 1 >= static_cast<double>(profile.size())) {
    return floor == beam && floor + 1 == static_cast<double>(profile.size()) ? profile.back() : std::nan("");
  }
  const auto k = static_cast<std::size_t>(floor);
  if (floor == beam) return profile[k];
  return 1 / ((1 - beam + floor) / profile[k] + (beam - floor) / profile[k + 1]);
}

/// [m] Of single ranges about the profile.
double noise_of(const std::vector<Row>& rows, const Row& profile) {
  std::vector<double> sizes;
  for (const Row& row : rows) {
    for (std::size_t k = 0; k < row.size(); ++k) {
      if (std::isfinite(row[k] - profile[k])) sizes.push_back(std::abs(row[k] - profile[k]));
    }
  }
  return kSigmaByMedian * middle_of(sizes);
}

/// Beams around which a profile is straight, as far as its noise lets one see.
std::vector<std::size_t> straight_beams(const std::vector<Row>& rows) {
  constexpr double kSeen = 3;              // standard errors
  constexpr std::size_t kReach = 2;        // beams, of all shifts
  const double kOfABend = std::sqrt(6.0);  // noise of a − 2 b + c
  const Row profile = mean_profile(rows);
  const double most =
      kSeen * kOfABend * noise_of(rows, profile) / std::sqrt(static_cast<double>(rows.size()));
  const auto is_straight = [&](std::size_t k) {
    const double bend = 1 / profile[k - 1] - 2 / profile[k] + 1 / profile[k + 1];
    return std::abs(bend) * profile[k] * profile[k] <= most;
  };
  std::vector<std::size_t> beams;
  for (std::size_t k = kReach; k + kReach < profile.size(); ++k) {
    if (is_straight(k - 1) && is_straight(k) && is_straight(k + 1)) beams.push_back(k);
  }
  return beams;
}

std::vector<Rest> rests_of(std::span<const SeriesScan> scans, std::size_t period) {
  std::vector<Rest> all;
  for (const SeriesScan& scan : scans) {
    if (all.empty() || scan.count - all.back().counts.back() > static_cast<std::int64_t>(kMostLags))
      all.emplace_back();
    all.back().rows.push_back(row_of(scan));
    all.back().kinds.push_back(kind_of(scan, period));
    all.back().counts.push_back(scan.count);
  }
  std::erase_if(all, [&](const Rest& rest) {
    for (std::size_t kind = 0; kind < period; ++kind) {
      if (rest.of(kind, true).size() < kFewestOfAKind || rest.of(kind, false).size() < kFewestOfAKind)
        return true;
    }
    return false;
  });
  return all;
}

/// The shift of one kind at which its profiles lie best on those that all are of.
double shift_of(const std::vector<Rest>& rests, const std::vector<Row>& references, std::size_t kind) {
  std::vector<Row> profiles;
  for (const Rest& rest : rests) profiles.push_back(mean_profile(rest.of(kind, true)));
  double best = 0;
  double least = std::numeric_limits<double>::infinity();
  for (const double shift : shift_grid()) {
    double sum = 0;
    for (std::size_t r = 0; r < rests.size(); ++r) {
      for (const std::size_t k : rests[r].beams) {
        if (k >= profiles[r].size()) continue;
        const double error =
            std::abs(profiles[r][k] - straight_at(references[r], static_cast<double>(k) + shift));
        sum += std::pow(std::fmin(kLargestRestError, error), 2);
      }
    }
    if (sum < least) {
      least = sum;
      best = shift;
    }
  }
  return best;
}

Interleave fitted(const std::vector<Rest>& rests, std::size_t reference, const std::vector<bool>& is_moved) {
  Interleave found{.shifts = std::vector<double>(is_moved.size()), .references = {}};
  for (const Rest& rest : rests) found.references.push_back(mean_profile(rest.of(reference, true)));
  for (std::size_t kind = 0; kind < is_moved.size(); ++kind) {
    if (is_moved[kind]) found.shifts[kind] = shift_of(rests, found.references, kind);
  }
  return found;
}

/// The scans that nothing was fitted to, less what is foretold of them.
struct Left {
  LagContrast lags;
  std::vector<std::size_t> kinds;
};

Left left_of(const std::vector<Rest>& rests, const Interleave* foretold) {
  std::vector<Row> rows;
  std::vector<std::int64_t> counts;
  std::vector<std::size_t> kinds;
  for (std::size_t r = 0; r < rests.size(); ++r) {
    const Rest& rest = rests[r];
    for (std::size_t i = 0; i < rest.rows.size(); ++i) {
      if (rest.is_fitted(i)) continue;
      Row left(rest.rows[i].size(), std::nan(""));
      for (const std::size_t k : rest.beams) {
        if (k >= left.size()) continue;
        left[k] = rest.rows[i][k];
        if (foretold != nullptr) {
          const double shift = foretold->shifts[rest.kinds[i]];
          left[k] -= straight_at(foretold->references[r], static_cast<double>(k) + shift);
        }
      }
      rows.push_back(std::move(left));
      counts.push_back(rest.counts[i]);
      kinds.push_back(rest.kinds[i]);
    }
  }
  return {.lags = {std::move(rows), counts}, .kinds = std::move(kinds)};
}

/// Scans about the mean of their kind in their half of the rest, as wide as they would be about the truth.
std::vector<Row> noise_of_kind(const Rest& rest, std::size_t kind) {
  std::vector<Row> all;
  for (const bool half : {true, false}) {
    const std::vector<Row> rows = rest.of(kind, half);
    const Row mean = mean_profile(rows);
    const auto n = static_cast<double>(rows.size());
    for (Row row : rows) {
      for (std::size_t k = 0; k < row.size(); ++k) row[k] = (row[k] - mean[k]) * std::sqrt(n / (n - 1));
      all.push_back(std::move(row));
    }
  }
  return all;
}

class Simulation {
 public:
  Simulation(const std::vector<Rest>& rests, const Interleave& truth) : rests_(rests), truth_(truth) {
    for (const Rest& rest : rests) {
      auto& of_rest = noise_.emplace_back();
      for (std::size_t kind = 0; kind < truth.shifts.size(); ++kind)
        of_rest.push_back(noise_of_kind(rest, kind));
    }
  }
  /// Noise of the measured scans, each of it once and of either sign: drawn twice, scans would be alike.
  std::vector<Rest> draw(std::mt19937_64& random) {
    std::vector<Rest> made = rests_;
    for (std::size_t r = 0; r < made.size(); ++r) {
      for (auto& of_kind : noise_[r]) std::ranges::shuffle(of_kind, random);
      std::vector<std::size_t> next(truth_.shifts.size(), 0);
      for (std::size_t i = 0; i < made[r].rows.size(); ++i) {
        const std::size_t kind = made[r].kinds[i];
        Row row = noise_[r][kind][next[kind]++];
        const double sign = random() % 2 == 0 ? 1 : -1;
        for (std::size_t k = 0; k < row.size(); ++k) {
          row[k] =
              sign * row[k] + straight_at(truth_.references[r], static_cast<double>(k) + truth_.shifts[kind]);
        }
        made[r].rows[i] = std::move(row);
      }
    }
    return made;
  }

 private:
  const std::vector<Rest>& rests_;
  Interleave truth_;
  std::vector<std::vector<std::vector<Row>>> noise_;  ///< by rest and kind
};

Likeness look(double amplitude, double p_value) {
  return corrected({{.covariate = "count of scans",
                     .quantity = "range",
                     .unit = "m",
                     .amplitude = std::max(0.0, amplitude),
                     .p_value = p_value}});
}

Likeness with_interleave(const std::vector<Rest>& rests, std::size_t reference,
                         const std::vector<bool>& is_moved, std::uint64_t seed) {
  const Interleave found = fitted(rests, reference, is_moved);
  const Left left = left_of(rests, &found);
  const double seen = left.lags.contrast();
  Simulation simulation(rests, found);
  std::mt19937_64 random(seed);
  std::size_t as_much = 0;
  double mean = 0;
  for (std::size_t s = 0; s < kSimulations; ++s) {
    const std::vector<Rest> made = simulation.draw(random);
    const Interleave again = fitted(made, reference, is_moved);
    const double contrast = left_of(made, &again).lags.contrast();
    mean += contrast / static_cast<double>(kSimulations);
    if (contrast >= seen) ++as_much;
  }
  const double between_kinds = static_cast<double>(as_much + 1) / static_cast<double>(kSimulations + 1);
  const auto within_kinds = left.lags.shuffled(seed, left.kinds);
  return look(seen - std::min(mean, within_kinds.contrast),
              least_of(2, std::min(between_kinds, within_kinds.p_value)));
}

}  // namespace

std::optional<ToldApart> told_at_rest(const std::string& laser, const std::vector<SeriesScan>& scans,
                                      const Alternation& alternation, const std::vector<bool>& is_moved,
                                      std::uint64_t seed) {
  if (std::ranges::find(is_moved, true) == is_moved.end()) {
    const Likeness alike = look(alternation.beyond_chance, alternation.p_value);
    return ToldApart{.scope = laser, .before = alike, .after = alike};
  }
  const std::size_t reference = reference_kind(scans, alternation.period);
  const auto some = std::span(scans).first(std::min(kEnoughAtRest, scans.size()));
  std::vector<Rest> rests = rests_of(some, alternation.period);
  std::size_t beams = 0;
  for (Rest& rest : rests) {
    rest.beams = straight_beams(rest.of(reference, true));
    beams += rest.beams.size();
  }
  if (beams < kFewestBeams) return {};
  const LagContrast plain = left_of(rests, nullptr).lags;
  const auto chance = plain.shuffled(seed);
  return ToldApart{.scope = laser,
                   .before = look(plain.contrast() - chance.contrast, chance.p_value),
                   .after = with_interleave(rests, reference, is_moved, seed)};
}

}  // namespace crisp
