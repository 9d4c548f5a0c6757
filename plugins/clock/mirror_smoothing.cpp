// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/clock/mirror_smoothing.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "pipeline/statistics/robust_estimators.hpp"

namespace crisp::clock {
namespace {

constexpr std::array<std::size_t, 6> kHalfWidths = {2, 3, 4, 6, 8, 10};
constexpr double kLargestGap = 10;  // of usual steps of the turn number, within a run
constexpr double kImplausible =
    0.05;  // a period this far from the usual one is a jump of stamps, not of the mirror
constexpr int kRounds = 3;
constexpr double kRobust = 3 * statistics::kMadToSigma;

using Stamps = std::span<const MirrorStamp>;

/// A parabola fitted about one stamp.
struct LocalFit {
  double offset = 0;    ///< [s] fitted time − the stamp's
  double period = 0;    ///< [s] a turn; 0 if there were too few stamps
  double leverage = 1;  ///< how much of its own error the fit follows
};

/// Least squares of time over turn, both relative to stamp i, by as high a degree (up to 2) as the number of
/// stamps allows: solves the normal equations by Cramer's rule.
LocalFit fit_about(Stamps run, std::size_t i, std::size_t half_width) {
  const std::size_t width = std::min(2 * half_width + 1, run.size());
  const std::size_t first = std::min(i - std::min(i, half_width), run.size() - width);
  if (width < 2) return {};
  double s1 = 0, s2 = 0, s3 = 0, s4 = 0, t0 = 0, t1 = 0, t2 = 0;
  for (std::size_t j = first; j < first + width; ++j) {
    const auto u = static_cast<double>(run[j].turn - run[i].turn);
    const double t = run[j].time - run[i].time;
    s1 += u;
    s2 += u * u;
    s3 += u * u * u;
    s4 += u * u * u * u;
    t0 += t;
    t1 += t * u;
    t2 += t * u * u;
  }
  const auto n = static_cast<double>(width);
  if (width < 4) {
    const double determinant = n * s2 - s1 * s1;
    return {(s2 * t0 - s1 * t1) / determinant, (n * t1 - s1 * t0) / determinant, s2 / determinant};
  }
  const double c00 = s2 * s4 - s3 * s3;
  const double c01 = s2 * s3 - s1 * s4;
  const double c02 = s1 * s3 - s2 * s2;
  const double c11 = n * s4 - s2 * s2;
  const double c12 = s1 * s2 - n * s3;
  const double determinant = n * c00 + s1 * c01 + s2 * c02;
  return {(c00 * t0 + c01 * t1 + c02 * t2) / determinant, (c01 * t0 + c11 * t1 + c12 * t2) / determinant,
          c00 / determinant};
}

/// Error of each stamp's prediction from its neighbours.
std::vector<double> foretelling_errors(Stamps run, std::size_t half_width) {
  std::vector<double> errors(run.size(), 0);
  for (std::size_t i = 0; i < run.size(); ++i) {
    const LocalFit fit = fit_about(run, i, half_width);
    if (fit.leverage < 1 - 1e-9) errors[i] = -fit.offset / (1 - fit.leverage);
  }
  return errors;
}

double scatter(const std::vector<double>& errors) {
  std::vector<double> sizes(errors.size());
  std::transform(errors.begin(), errors.end(), sizes.begin(), [](double e) { return std::abs(e); });
  return sizes.empty() ? 0 : statistics::median_in_place(sizes);
}

/// Stamps without large gaps between them.
std::vector<Stamps> runs_of(Stamps stamps) {
  std::vector<double> steps;
  for (std::size_t i = 1; i < stamps.size(); ++i) {
    steps.push_back(static_cast<double>(stamps[i].turn - stamps[i - 1].turn));
  }
  auto ordered = steps;
  const double largest = kLargestGap * statistics::median_in_place(ordered);
  std::vector<Stamps> runs;
  std::size_t begin = 0;
  for (std::size_t i = 1; i <= stamps.size(); ++i) {
    if (i < stamps.size() && steps[i - 1] <= largest) continue;
    runs.push_back(stamps.subspan(begin, i - begin));
    begin = i;
  }
  return runs;
}

std::size_t best_half_width(const std::vector<Stamps>& runs) {
  const auto longest = *std::max_element(
      runs.begin(), runs.end(), [](const Stamps& a, const Stamps& b) { return a.size() < b.size(); });
  std::size_t best = kHalfWidths.front();
  double least = HUGE_VAL;
  for (const std::size_t half_width : kHalfWidths) {
    if (longest.size() < 4 * half_width) break;
    const double error = scatter(foretelling_errors(longest, half_width));
    if (error < least) {
      least = error;
      best = half_width;
    }
  }
  return best;
}

/// The stamps, with outliers clipped to the bound around their prediction. An outlier affects its neighbours'
/// predictions, too, until it is clipped: hence more than one round.
std::vector<MirrorStamp> tamed(Stamps run, std::size_t half_width) {
  std::vector<MirrorStamp> tame(run.begin(), run.end());
  auto errors = foretelling_errors(run, half_width);
  for (int round = 0; round < kRounds; ++round) {
    const double bound = kRobust * scatter(errors);
    for (std::size_t i = 0; i < run.size(); ++i) {
      tame[i].time = run[i].time - (errors[i] - std::clamp(errors[i], -bound, bound));
    }
    const auto after = foretelling_errors(tame, half_width);
    for (std::size_t i = 0; i < run.size(); ++i) errors[i] = after[i] + run[i].time - tame[i].time;
  }
  return tame;
}

void smooth_run(Stamps run, std::size_t half_width, std::vector<MirrorTurn>& turns) {
  const auto stamps = tamed(run, half_width);
  for (std::size_t i = 0; i < run.size(); ++i) {
    const LocalFit fit = fit_about(stamps, i, half_width);
    turns.push_back({.time = stamps[i].time + fit.offset, .period = fit.period});
  }
}

}  // namespace

std::vector<MirrorTurn> smooth_mirror(Stamps stamps, const MirrorSmoothing& smoothing) {
  std::vector<MirrorTurn> turns;
  if (stamps.empty()) return turns;
  const auto runs = runs_of(stamps);
  const std::size_t half_width = smoothing.half_width > 0 ? smoothing.half_width : best_half_width(runs);
  turns.reserve(stamps.size());
  for (const auto& run : runs) smooth_run(run, half_width, turns);

  std::vector<double> periods;
  for (const auto& turn : turns) {
    if (turn.period > 0) periods.push_back(turn.period);
  }
  const double usual = periods.empty() ? smoothing.nominal_period : statistics::median_in_place(periods);
  for (auto& turn : turns) {
    if (std::abs(turn.period - usual) > kImplausible * usual) turn.period = usual;
  }
  return turns;
}

}  // namespace crisp::clock
