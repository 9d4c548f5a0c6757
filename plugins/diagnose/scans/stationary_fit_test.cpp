// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/diagnose/scans/stationary_fit_test.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "pipeline/statistics/monte_carlo_test.hpp"
#include "pipeline/statistics/multiple_testing.hpp"
#include "pipeline/statistics/random_stream.hpp"
#include "pipeline/statistics/robust_estimators.hpp"
#include "plugins/diagnose/scans/lag_contrast.hpp"
#include "plugins/diagnose/scans/stationary_profiles.hpp"

namespace crisp::diagnose {
namespace {

using Row = std::vector<double>;

constexpr double kLargestProfileError = 0.1;  // [m] truncation of differences between profiles
constexpr std::size_t kMinOfAKind = 4;        // scans per class and half of a stationary phase
constexpr std::size_t kMinBeams = 20;         // over all stationary phases
constexpr std::size_t kSimulations = 499;

/// Scans of one stationary phase; the first half is the training set.
struct StationaryPhase {
  std::vector<Row> rows;
  std::vector<std::size_t> kinds;
  std::vector<std::int64_t> counts;
  std::vector<std::size_t> beams = {};  ///< beams used in the test

  bool is_fitted(std::size_t i) const { return 2 * i < rows.size(); }
  std::vector<Row> of(std::size_t kind, bool fitted) const {
    std::vector<Row> some;
    for (std::size_t i = 0; i < rows.size(); ++i) {
      if (kinds[i] == kind && is_fitted(i) == fitted) some.push_back(rows[i]);
    }
    return some;
  }
};

/// Prediction of an interleave: class shifts and reference profiles.
struct InterleaveModel {
  std::vector<double> shifts;   ///< [beams] by class
  std::vector<Row> references;  ///< [m] by stationary phase: the common profile
};

/// Range between two beams of a profile, interpolated linearly in space: on a straight line the inverse range
/// is nearly linear in the angle.
double straight_at(const Row& profile, double beam) {
  const double floor = std::floor(beam);
  if (floor < 0 || floor + 1 >= static_cast<double>(profile.size())) {
    return floor == beam && floor + 1 == static_cast<double>(profile.size()) ? profile.back() : std::nan("");
  }
  const auto k = static_cast<std::size_t>(floor);
  if (floor == beam) return profile[k];
  return 1 / ((1 - beam + floor) / profile[k] + (beam - floor) / profile[k + 1]);
}

/// [m] Noise of single ranges about the profile.
double noise_of(const std::vector<Row>& rows, const Row& profile) {
  std::vector<double> sizes;
  for (const Row& row : rows) {
    for (std::size_t k = 0; k < row.size(); ++k) {
      if (std::isfinite(row[k] - profile[k])) sizes.push_back(std::abs(row[k] - profile[k]));
    }
  }
  return statistics::kMadToSigma * statistics::median_in_place(sizes);
}

/// Beams around which the profile is straight within its noise.
std::vector<std::size_t> straight_beams(const std::vector<Row>& rows) {
  constexpr double kSeen = 3;              // standard errors
  constexpr std::size_t kReach = 2;        // beams, the largest shift
  const double kOfABend = std::sqrt(6.0);  // noise of the second difference a − 2 b + c
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

std::vector<StationaryPhase> rests_of(std::span<const SeriesScan> scans, std::size_t period) {
  std::vector<StationaryPhase> all;
  for (const SeriesScan& scan : scans) {
    if (all.empty() || scan.count - all.back().counts.back() > static_cast<std::int64_t>(kMaxLags))
      all.emplace_back();
    all.back().rows.push_back(row_of(scan));
    all.back().kinds.push_back(class_of(scan, period));
    all.back().counts.push_back(scan.count);
  }
  std::erase_if(all, [&](const StationaryPhase& phase) {
    for (std::size_t kind = 0; kind < period; ++kind) {
      if (phase.of(kind, true).size() < kMinOfAKind || phase.of(kind, false).size() < kMinOfAKind)
        return true;
    }
    return false;
  });
  return all;
}

/// Shift of one class that minimizes the difference of its profiles from the common ones.
double shift_of(const std::vector<StationaryPhase>& phases, const std::vector<Row>& references,
                std::size_t kind) {
  std::vector<Row> profiles;
  for (const StationaryPhase& phase : phases) profiles.push_back(mean_profile(phase.of(kind, true)));
  double best = 0;
  double least = std::numeric_limits<double>::infinity();
  for (const double shift : shift_grid()) {
    double sum = 0;
    for (std::size_t r = 0; r < phases.size(); ++r) {
      for (const std::size_t k : phases[r].beams) {
        if (k >= profiles[r].size()) continue;
        const double error =
            std::abs(profiles[r][k] - straight_at(references[r], static_cast<double>(k) + shift));
        sum += std::pow(std::fmin(kLargestProfileError, error), 2);
      }
    }
    if (sum < least) {
      least = sum;
      best = shift;
    }
  }
  return best;
}

InterleaveModel fitted(const std::vector<StationaryPhase>& phases, std::size_t reference,
                       const std::vector<bool>& is_moved) {
  InterleaveModel found{.shifts = std::vector<double>(is_moved.size()), .references = {}};
  for (const StationaryPhase& phase : phases)
    found.references.push_back(mean_profile(phase.of(reference, true)));
  for (std::size_t kind = 0; kind < is_moved.size(); ++kind) {
    if (is_moved[kind]) found.shifts[kind] = shift_of(phases, found.references, kind);
  }
  return found;
}

/// Residuals of the held-out scans.
struct Left {
  LagContrast lags;
  std::vector<std::size_t> kinds;
};

Left left_of(const std::vector<StationaryPhase>& phases, const InterleaveModel* predicted) {
  std::vector<Row> rows;
  std::vector<std::int64_t> counts;
  std::vector<std::size_t> kinds;
  for (std::size_t r = 0; r < phases.size(); ++r) {
    const StationaryPhase& phase = phases[r];
    for (std::size_t i = 0; i < phase.rows.size(); ++i) {
      if (phase.is_fitted(i)) continue;
      Row left(phase.rows[i].size(), std::nan(""));
      for (const std::size_t k : phase.beams) {
        if (k >= left.size()) continue;
        left[k] = phase.rows[i][k];
        if (predicted != nullptr) {
          const double shift = predicted->shifts[phase.kinds[i]];
          left[k] -= straight_at(predicted->references[r], static_cast<double>(k) + shift);
        }
      }
      rows.push_back(std::move(left));
      counts.push_back(phase.counts[i]);
      kinds.push_back(phase.kinds[i]);
    }
  }
  return {.lags = {std::move(rows), counts}, .kinds = std::move(kinds)};
}

/// Residuals of a class about its mean within a half, scaled to the noise about the true profile.
std::vector<Row> noise_of_kind(const StationaryPhase& phase, std::size_t kind) {
  std::vector<Row> all;
  for (const bool half : {true, false}) {
    const std::vector<Row> rows = phase.of(kind, half);
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
  Simulation(const std::vector<StationaryPhase>& phases, const InterleaveModel& truth)
      : phases_(phases), truth_(truth) {
    for (const StationaryPhase& phase : phases) {
      auto& of_rest = noise_.emplace_back();
      for (std::size_t kind = 0; kind < truth.shifts.size(); ++kind)
        of_rest.push_back(noise_of_kind(phase, kind));
    }
  }
  /// Draws permuted, sign-flipped noise of the measured scans. Sampling without replacement avoids identical
  /// scans.
  std::vector<StationaryPhase> draw(statistics::RandomStream& random) {
    std::vector<StationaryPhase> made = phases_;
    for (std::size_t r = 0; r < made.size(); ++r) {
      for (auto& of_class : noise_[r]) random.shuffle(of_class);
      std::vector<std::size_t> next(truth_.shifts.size(), 0);
      for (std::size_t i = 0; i < made[r].rows.size(); ++i) {
        const std::size_t kind = made[r].kinds[i];
        Row row = noise_[r][kind][next[kind]++];
        const double sign = random.sign();
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
  const std::vector<StationaryPhase>& phases_;
  InterleaveModel truth_;
  std::vector<std::vector<std::vector<Row>>> noise_;  ///< by stationary phase and class
};

data::FitStatistics test(double amplitude, double p_value) {
  return data::corrected({{.covariate = "count of scans",
                           .quantity = "range",
                           .unit = "m",
                           .amplitude = std::max(0.0, amplitude),
                           .p_value = p_value}});
}

data::FitStatistics with_interleave(const std::vector<StationaryPhase>& phases, std::size_t reference,
                                    const std::vector<bool>& is_moved, std::uint64_t seed) {
  const InterleaveModel found = fitted(phases, reference, is_moved);
  const Left left = left_of(phases, &found);
  const double seen = left.lags.contrast();
  Simulation simulation(phases, found);
  statistics::RandomStream random(seed, "scans");
  const auto between_kinds = statistics::monte_carlo_test(seen, kSimulations, [&] {
    const std::vector<StationaryPhase> made = simulation.draw(random);
    const InterleaveModel again = fitted(made, reference, is_moved);
    return left_of(made, &again).lags.contrast();
  });
  const auto within_kinds = left.lags.permutation_test(seed, left.kinds);
  return test(seen - std::min(between_kinds.mean, within_kinds.mean),
              statistics::sidak_p_value(2, std::min(between_kinds.p_value, within_kinds.p_value)));
}

}  // namespace

std::optional<data::GoodnessOfFit> stationary_fit_test(const std::string& laser,
                                                       const std::vector<SeriesScan>& scans,
                                                       const ScanInterleave& interleave,
                                                       const std::vector<bool>& is_moved,
                                                       std::uint64_t seed) {
  if (std::ranges::find(is_moved, true) == is_moved.end()) {
    const data::FitStatistics alike = test(interleave.beyond_chance, interleave.p_value);
    return data::GoodnessOfFit{.scope = laser, .before = alike, .after = alike};
  }
  const std::size_t reference = reference_class(scans, interleave.period);
  const auto some = std::span(scans).first(std::min(kEnoughStationary, scans.size()));
  std::vector<StationaryPhase> phases = rests_of(some, interleave.period);
  std::size_t beams = 0;
  for (StationaryPhase& phase : phases) {
    phase.beams = straight_beams(phase.of(reference, true));
    beams += phase.beams.size();
  }
  if (beams < kMinBeams) return {};
  const LagContrast plain = left_of(phases, nullptr).lags;
  const auto chance = plain.permutation_test(seed);
  return data::GoodnessOfFit{.scope = laser,
                             .before = test(plain.contrast() - chance.mean, chance.p_value),
                             .after = with_interleave(phases, reference, is_moved, seed)};
}

}  // namespace crisp::diagnose
