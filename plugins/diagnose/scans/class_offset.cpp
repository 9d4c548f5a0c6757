// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>

#include "pipeline/statistics/bootstrap.hpp"
#include "pipeline/statistics/robust_estimators.hpp"
#include "plugins/diagnose/scans/interleave.hpp"
#include "plugins/diagnose/scans/stationary_profiles.hpp"

namespace crisp::diagnose {
namespace {

constexpr double kNearNeighbours = 0.15;  // [m] largest difference between neighbouring compared beams
constexpr double kLargestError = 0.1;     // [m] truncation of errors
constexpr double kLargestShift = 1.5;     // [beams]
constexpr int kStepsABeam = 100;
constexpr std::size_t kBlock = 6;  // beams per resampling unit: they share a surface
constexpr std::size_t kDraws = 400;

using Profile = std::vector<double>;

/// Profiles of both classes, and their difference at each shift.
class Comparison {
 public:
  Comparison(Profile reference, Profile other) : reference_(std::move(reference)), other_(std::move(other)) {
    for (std::size_t k = 0; k < other_.size(); ++k) {
      if (counts(k)) beams_.push_back(k);
    }
    for (const double shift : shift_grid()) errors_.push_back(errors(shift));
  }

  std::size_t size() const { return beams_.size(); }
  const std::vector<std::size_t>& beams() const { return beams_; }
  Profile errors(double shift) const {
    Profile all;
    for (const auto k : beams_)
      all.push_back(other_[k] - at_beam(reference_, static_cast<double>(k) + shift));
    return all;
  }
  const std::vector<Profile>& over_shifts() const { return errors_; }
  double reference(std::size_t k) const { return reference_[k]; }

 private:
  /// Whether all ranges within the largest shift are there, without an edge.
  bool counts(std::size_t k) const {
    constexpr std::size_t kReach = 2;
    if (k < kReach || k + kReach >= reference_.size() || !std::isfinite(other_[k])) return false;
    for (std::size_t j = k - kReach; j < k + kReach; ++j) {
      if (!(std::abs(reference_[j + 1] - reference_[j]) < kNearNeighbours)) return false;
    }
    return true;
  }

  Profile reference_, other_;
  std::vector<std::size_t> beams_;
  std::vector<Profile> errors_;  ///< by shift
};

double clipped(double error) { return std::min(std::abs(error), kLargestError); }

double squares(const Profile& errors, const std::vector<std::size_t>& picked) {
  double sum = 0;
  for (const auto i : picked) sum += clipped(errors[i]) * clipped(errors[i]);
  return sum;
}

std::vector<std::size_t> everyone(std::size_t n) {
  std::vector<std::size_t> all(n);
  for (std::size_t i = 0; i < n; ++i) all[i] = i;
  return all;
}

double best_shift(const Comparison& comparison, const std::vector<std::size_t>& picked) {
  const auto& grid = shift_grid();
  std::size_t best = 0;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t g = 0; g < grid.size(); ++g) {
    const double sum = squares(comparison.over_shifts()[g], picked);
    if (sum < least) {
      least = sum;
      best = g;
    }
  }
  return grid[best];
}

double mean_of(const Profile& errors, const std::vector<std::size_t>& picked) {
  std::vector<double> values;
  for (const auto i : picked) values.push_back(errors[i]);
  return statistics::median_in_place(values);
}

double rms(const Profile& errors, const std::vector<std::size_t>& picked) {
  return std::sqrt(squares(errors, picked) / static_cast<double>(std::max<std::size_t>(picked.size(), 1)));
}

/// −BIC/2 of errors under a Laplace distribution, which is robust against edges.
double log_evidence(const Profile& errors, int parameters) {
  double sum = 0;
  for (const double error : errors) sum += clipped(error);
  const auto n = static_cast<double>(errors.size());
  return -n * std::log(std::max(sum / n, 1e-6)) - 0.5 * parameters * std::log(n);
}

void weigh(const Comparison& comparison, ClassOffset& class_offset) {
  const Profile plain = comparison.errors(0);
  const auto all = everyone(comparison.size());
  const double offset = mean_of(plain, all);
  std::vector<double> ratios;
  for (std::size_t i = 0; i < plain.size(); ++i) {
    ratios.push_back(plain[i] / comparison.reference(comparison.beams()[i]));
  }
  const double scale = statistics::median_in_place(ratios);
  Profile less_offset = plain;
  Profile less_scale = plain;
  for (std::size_t i = 0; i < plain.size(); ++i) {
    less_offset[i] -= offset;
    less_scale[i] -= scale * comparison.reference(comparison.beams()[i]);
  }
  const std::vector<std::pair<double, const char*>> others = {{log_evidence(plain, 0), "nothing"},
                                                              {log_evidence(less_offset, 1), "range.offset"},
                                                              {log_evidence(less_scale, 1), "range.scale"}};
  const auto next = *std::max_element(others.begin(), others.end());
  class_offset.log10_bayes_factor =
      (log_evidence(comparison.errors(class_offset.shift), 1) - next.first) / std::log(10.0);
  class_offset.next_likely = next.second;
}

Gain judge(const Comparison& held_out, double shift, std::uint64_t seed) {
  const Profile before = held_out.errors(0);
  const Profile after = held_out.errors(shift);
  const auto all = everyone(held_out.size());
  Gain gain{.metric = "stationary profile: RMS between scan classes",
            .unit = "m",
            .before = rms(before, all),
            .after = rms(after, all)};
  gain.ci95 = statistics::bootstrap(held_out.size(), kBlock, seed, kDraws, [&](const auto& picked) {
                return rms(after, picked) - rms(before, picked);
              }).ci95;
  return gain;
}

/// Injection test: half of the reference scans are shifted by interpolation and compared with the other half.
void inject_shift(const std::vector<SeriesScan>& reference, ClassOffset& class_offset) {
  constexpr double kInjected = 0.3;  // [beams]
  std::vector<SeriesScan> even, odd;
  for (std::size_t i = 0; i < reference.size(); ++i) (i % 2 == 0 ? even : odd).push_back(reference[i]);
  const Profile profile = mean_profile(odd);
  Profile moved;
  for (std::size_t k = 0; k < profile.size(); ++k)
    moved.push_back(at_beam(profile, static_cast<double>(k) + kInjected));
  const Comparison comparison(mean_profile(even), moved);
  class_offset.injected = kInjected;
  class_offset.recovered = best_shift(comparison, everyone(comparison.size()));
}

std::vector<SeriesScan> of_class(const std::vector<SeriesScan>& scans, std::size_t period, std::size_t kind,
                                 bool first_half) {
  std::vector<SeriesScan> some;
  for (std::size_t i = 0; i < scans.size(); ++i) {
    if ((2 * i < scans.size()) == first_half && class_of(scans[i], period) == kind) some.push_back(scans[i]);
  }
  return some;
}

}  // namespace

const std::vector<double>& shift_grid() {
  static const std::vector<double> grid = [] {
    std::vector<double> all;
    const int most = static_cast<int>(std::lround(kLargestShift * kStepsABeam));
    for (int i = -most; i <= most; ++i) all.push_back(static_cast<double>(i) / kStepsABeam);
    return all;
  }();
  return grid;
}

std::vector<ClassOffset> compare_classes(const std::vector<SeriesScan>& scans, std::size_t period,
                                         std::uint64_t seed) {
  const std::size_t reference = reference_class(scans, period);
  std::vector<ClassOffset> all;
  for (std::size_t kind = 0; kind < period; ++kind) {
    if (kind == reference) continue;
    const auto mine = of_class(scans, period, kind, true);
    const auto others = of_class(scans, period, reference, true);
    const Comparison found(mean_profile(others), mean_profile(mine));
    ClassOffset class_offset{.kind = kind, .scans = 2 * mine.size(), .beams = found.size()};
    const auto beams = everyone(found.size());
    constexpr std::size_t kMin = 20;
    if (found.size() < kMin) continue;
    class_offset.shift = best_shift(found, beams);
    class_offset.shift_error =
        statistics::bootstrap(found.size(), kBlock, seed, kDraws, [&](const auto& picked) {
          return best_shift(found, picked);
        }).std_error;
    const Profile left = found.errors(class_offset.shift);
    class_offset.offset = mean_of(left, beams);
    class_offset.offset_error =
        statistics::bootstrap(found.size(), kBlock, seed, kDraws, [&](const auto& picked) {
          return mean_of(left, picked);
        }).std_error;
    weigh(found, class_offset);
    for (const auto& errors : found.over_shifts())
      class_offset.error_over_shift.push_back(rms(errors, beams));
    const Comparison held_out(mean_profile(of_class(scans, period, reference, false)),
                              mean_profile(of_class(scans, period, kind, false)));
    class_offset.gain = judge(held_out, class_offset.shift, seed);
    inject_shift(others, class_offset);
    all.push_back(std::move(class_offset));
  }
  return all;
}

}  // namespace crisp::diagnose
