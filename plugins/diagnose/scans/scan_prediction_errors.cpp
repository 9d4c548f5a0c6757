// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/diagnose/scans/scan_prediction_errors.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "pipeline/statistics/bootstrap.hpp"
#include "pipeline/statistics/robust_estimators.hpp"

namespace crisp::diagnose {
namespace {

constexpr std::size_t kFar = 2;                     // scans on either side that select the beams
constexpr double kMinSlope = 0.1, kMaxSlope = 0.6;  // [m]
constexpr double kNoEdge = 0.2;                     // [m]
constexpr double kNearBeams = 0.3;   // [m] largest difference of interpolated neighbouring beams
constexpr double kMinMotion = 1e-3;  // [rad] of the actuator over four scans

/// Range of a scan in a direction, interpolated linearly between beams; empty at an edge or without an echo.
std::optional<double> range_at(const SeriesScan& scan, double first_angle, double angle) {
  constexpr double kRounding = 1e-6;
  if (scan.scan->angle_step == 0) return {};  // a single beam
  const double beam = (angle - first_angle) / scan.scan->angle_step;
  const double floor = std::floor(beam + kRounding);
  const double on = std::max(0.0, beam - floor);
  const auto& ranges = scan.ranges();
  if (floor < 0 || floor >= static_cast<double>(ranges.size())) return {};
  const auto k = static_cast<std::size_t>(floor);
  const auto here = static_cast<double>(ranges[k]);
  if (!(here > 0)) return {};
  if (on < kRounding) return here;
  if (k + 1 >= ranges.size() || !(ranges[k + 1] > 0)) return {};
  const auto there = static_cast<double>(ranges[k + 1]);
  if (std::abs(there - here) > kNearBeams) return {};
  return (1 - on) * here + on * there;
}

bool slopes(const SeriesScan& before, const SeriesScan& scan, const SeriesScan& after, std::size_t k) {
  if (k >= before.ranges().size() || k >= after.ranges().size()) return false;
  const auto u = static_cast<double>(before.ranges()[k]);
  const auto r = static_cast<double>(scan.ranges()[k]);
  const auto v = static_cast<double>(after.ranges()[k]);
  if (!(u > 0) || !(r > 0) || !(v > 0)) return false;
  const double slope = std::abs(v - u);
  return slope > kMinSlope && slope < kMaxSlope && std::abs(r - (u + v) / 2) < kNoEdge;
}

/// Relative position of the actuator at a scan between the scans before and after; empty if it hardly moves.
std::optional<double> share_of(const PlateTrajectory& plate, const std::vector<double>& times,
                               std::size_t i) {
  const auto first = plate.at(times[i - kFar]), last = plate.at(times[i + kFar]);
  const auto before = plate.at(times[i - 1]), now = plate.at(times[i]), after = plate.at(times[i + 1]);
  if (!first || !last || !before || !now || !after) return {};
  if (std::abs(last->angle - first->angle) < kMinMotion) return {};
  const double way = after->angle - before->angle;
  constexpr double kMinWay = 1e-5;  // [rad]
  return std::abs(way) < kMinWay ? 0.5 : (now->angle - before->angle) / way;
}

/// Weights of five scans that cancel ranges of second order in the actuator's angle. They take the
/// interpolation error of the nearer two less that of the farther two, scaled by their spacing.
std::optional<std::array<double, 2 * kFar + 1>> weights_around(const PlateTrajectory& plate,
                                                               const std::vector<double>& times,
                                                               std::size_t i) {
  const auto share = share_of(plate, times, i);
  if (!share) return {};
  std::array<double, 2 * kFar + 1> off{};  // [rad] relative to the middle scan
  for (std::size_t j = 0; j < off.size(); ++j) {
    off[j] = plate.at(times[i + j - kFar])->angle - plate.at(times[i])->angle;
  }
  const double far_bend = off.front() * off.back();
  const double bend = far_bend < 0 ? std::clamp(off[kFar - 1] * off[kFar + 1] / far_bend, 0.0, 1.0) : 0;
  const double far_share = off.front() / (off.front() - off.back());
  return {{bend * (1 - far_share), -(1 - *share), 1 - bend, -*share, bend * far_share}};
}

}  // namespace

double ScanPredictionErrors::median() const {
  std::vector<double> all;
  for (const auto& of_scan : errors) all.insert(all.end(), of_scan.begin(), of_scan.end());
  return statistics::median_in_place(all);
}

ScanPredictionErrors scan_prediction_errors(const std::vector<SeriesScan>& scans,
                                            const std::vector<double>& times,
                                            const std::vector<double>& angles, const PlateTrajectory& plate) {
  ScanPredictionErrors found;
  for (std::size_t i = kFar; i + kFar < scans.size(); ++i) {
    const auto share = share_of(plate, times, i);
    if (!share) continue;
    std::vector<double> errors;
    for (std::size_t k = 0; k < scans[i].ranges().size(); ++k) {
      if (!slopes(scans[i - kFar], scans[i], scans[i + kFar], k)) continue;
      const double angle = angles[i] + static_cast<double>(k) * scans[i].scan->angle_step;
      const auto before = range_at(scans[i - 1], angles[i - 1], angle);
      const auto after = range_at(scans[i + 1], angles[i + 1], angle);
      if (!before || !after) continue;
      const double predicted = *before + *share * (*after - *before);
      errors.push_back(std::abs(static_cast<double>(scans[i].ranges()[k]) - predicted));
    }
    if (errors.empty()) continue;
    found.scan.push_back(i);
    found.errors.push_back(std::move(errors));
  }
  return found;
}

std::vector<ScanScore> scan_scores(const std::vector<SeriesScan>& scans, const std::vector<double>& times,
                                   const std::vector<double>& angles, const PlateTrajectory& plate) {
  std::vector<ScanScore> all;
  for (std::size_t i = kFar; i + kFar < scans.size(); ++i) {
    const auto weights = weights_around(plate, times, i);
    if (!weights) continue;
    ScanScore of{.scan = i, .weights = *weights};
    for (std::size_t k = 0; k < scans[i].ranges().size(); ++k) {
      if (!slopes(scans[i - kFar], scans[i], scans[i + kFar], k)) continue;
      const double angle = angles[i] + static_cast<double>(k) * scans[i].scan->angle_step;
      double beyond = 0;
      for (std::size_t j = 0; j < weights->size(); ++j) {
        const auto range = range_at(scans[i + j - kFar], angles[i + j - kFar], angle);
        beyond += (*weights)[j] * range.value_or(std::nan(""));
      }
      if (!std::isfinite(beyond)) continue;
      const auto slope =
          static_cast<double>(scans[i + kFar].ranges()[k]) - static_cast<double>(scans[i - kFar].ranges()[k]);
      of.score += std::clamp(beyond, -kNoEdge, kNoEdge) * slope;
      of.squares += slope * slope;
      of.beams += 1;
    }
    if (of.beams > 0) all.push_back(of);
  }
  return all;
}

Gain prediction_gain(const ScanPredictionErrors& before, const ScanPredictionErrors& after,
                     std::uint64_t seed) {
  constexpr std::size_t kBlockOfScans = 5;
  constexpr std::size_t kDrawsOfScans = 400;
  std::vector<std::pair<std::size_t, std::size_t>> both;
  for (std::size_t i = 0; i < before.scan.size(); ++i) {
    const auto other = std::lower_bound(after.scan.begin(), after.scan.end(), before.scan[i]);
    if (other == after.scan.end() || *other != before.scan[i]) continue;
    both.emplace_back(i, static_cast<std::size_t>(other - after.scan.begin()));
  }
  const auto medians = [&](const std::vector<std::size_t>& picked) {
    std::vector<double> old_errors, new_errors;
    for (const auto i : picked) {
      const auto& old_ones = before.errors[both[i].first];
      const auto& new_ones = after.errors[both[i].second];
      old_errors.insert(old_errors.end(), old_ones.begin(), old_ones.end());
      new_errors.insert(new_errors.end(), new_ones.begin(), new_ones.end());
    }
    return std::pair(statistics::median_in_place(old_errors), statistics::median_in_place(new_errors));
  };
  std::vector<std::size_t> all(both.size());
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = i;
  const auto [old_median, new_median] = medians(all);
  Gain gain{.metric = "scan predicted by its neighbours: median error",
            .unit = "m",
            .before = old_median,
            .after = new_median};
  gain.ci95 = statistics::bootstrap(both.size(), kBlockOfScans, seed, kDrawsOfScans, [&](const auto& picked) {
                const auto [old_drawn, new_drawn] = medians(picked);
                return new_drawn - old_drawn;
              }).ci95;
  return gain;
}

}  // namespace crisp::diagnose
