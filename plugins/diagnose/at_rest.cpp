// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/diagnose/at_rest.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "pipeline/clocks/series.hpp"
#include "pipeline/data/middle.hpp"
#include "plugins/diagnose/series.hpp"

namespace crisp {
namespace {

constexpr std::array kWarmUps = {0.03, 0.1, 0.3, 1.0};  // time constants, as shares of the recording

double at(const CommonChange& change, double seconds) {
  if (change.is_step) return seconds >= change.shape ? change.size : 0;
  return change.size * (1 - std::exp(-seconds / change.shape));
}

/// Mean error of each scan's beams.
Eigen::VectorXd means(const RangeErrors& errors, std::size_t scans) {
  Eigen::VectorXd sums = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(scans));
  Eigen::VectorXd counts = sums;
  for (std::size_t i = 0; i < errors.size(); ++i) {
    sums[errors.block[i]] += double{errors.value[i]};
    counts[errors.block[i]] += 1;
  }
  return sums.cwiseQuotient(counts.cwiseMax(1));
}

/// The least sum of squares that one of the columns, and a mean, leave of some values.
double squares_left(const Eigen::Ref<const Eigen::MatrixXd>& columns, const Eigen::VectorXd& values) {
  const Eigen::VectorXd centred = values.array() - values.mean();
  double most = 0;
  for (Eigen::Index k = 0; k < columns.cols(); ++k) {
    const Eigen::VectorXd column = columns.col(k).array() - columns.col(k).mean();
    const double square = column.squaredNorm();
    if (square > 0) most = std::max(most, std::pow(column.dot(centred), 2) / square);
  }
  return centred.squaredNorm() - most;
}

/// What is left by one kind of change against what is by the other, and by none, which has two parameters
/// less.
double log10_odds_of(double own, double other, double none, double n) {
  const double ahead_of_other = n * std::log(other / own);
  const double ahead_of_none = n * std::log(none / own) - 2 * std::log(n);
  return std::min(ahead_of_other, ahead_of_none) / 2 / std::numbers::ln10;
}

}  // namespace

void AtRest::add(const Scan& scan) {
  constexpr std::size_t kMostScans = 4000;  // bounds the memory; so many tell all there is to tell
  if (scan.echoes.empty() || receipt_ns_.size() >= kMostScans) {
    ++left_out_;
    return;
  }
  const auto& ranges = scan.echoes.front().ranges;
  if (receipt_ns_.empty()) beams_ = ranges.size();
  if (ranges.size() != beams_) {
    ++left_out_;
    return;
  }
  ranges_.insert(ranges_.end(), ranges.begin(), ranges.end());
  receipt_ns_.push_back(scan.receipt_ns);
}

std::optional<RangeErrors> AtRest::errors() const {
  constexpr double kMostSpread = 0.03;   // [m]
  constexpr double kLeastCame = 0.8;     // of a beam's shots
  constexpr double kLeastSteady = 0.25;  // of the beams that come back
  constexpr float kLeastRange = 0.016F;  // [m] below there are codes
  RangeErrors all;
  std::size_t steady = 0;
  std::size_t seen = 0;
  for (std::size_t beam = 0; beam < beams_; ++beam) {
    std::vector<std::size_t> shots;
    double mean = 0;
    for (std::size_t scan = 0; scan < scans(); ++scan) {
      const float range = ranges_[scan * beams_ + beam];
      if (!(range > kLeastRange) || !std::isfinite(range)) continue;
      shots.push_back(scan);
      mean += double{range};
    }
    if (static_cast<double>(shots.size()) < kLeastCame * static_cast<double>(scans())) continue;
    mean /= static_cast<double>(shots.size());
    ++seen;
    std::vector<double> off;
    for (const std::size_t scan : shots)
      off.push_back(std::abs(double{ranges_[scan * beams_ + beam]} - mean));
    constexpr double kOfNormal = 1.4826;
    if (kOfNormal * middle_of(off) > kMostSpread) continue;
    ++steady;
    for (const std::size_t scan : shots) {
      all.value.push_back(static_cast<float>(double{ranges_[scan * beams_ + beam]} - mean));
      all.range.push_back(static_cast<float>(mean));
      all.beam.push_back(static_cast<std::uint16_t>(beam));
      all.block.push_back(static_cast<std::uint32_t>(scan));
    }
  }
  if (static_cast<double>(steady) < kLeastSteady * static_cast<double>(seen) || steady == 0)
    return std::nullopt;
  return all;
}

std::optional<CommonChange> common_change(const RangeErrors& errors, const std::vector<double>& seconds,
                                          std::size_t looks, std::uint64_t seed) {
  constexpr Eigen::Index kMargin = 4;
  const auto n = static_cast<Eigen::Index>(seconds.size());
  if (n < 4 * kMargin) return std::nullopt;
  const Eigen::MatrixXd jumps = steps(n, kMargin);
  Eigen::MatrixXd columns(n, jumps.cols() + static_cast<Eigen::Index>(kWarmUps.size()));
  columns.leftCols(jumps.cols()) = jumps;
  const Eigen::ArrayXd time = Eigen::Map<const Eigen::ArrayXd>(seconds.data(), n) - seconds.front();
  for (std::size_t k = 0; k < kWarmUps.size(); ++k) {
    const double constant = kWarmUps[k] * time[n - 1];
    columns.col(jumps.cols() + static_cast<Eigen::Index>(k)) = 1 - (-time / constant).exp();
  }
  const Eigen::VectorXd values = means(errors, seconds.size());
  const SeriesLook look = look_at_series(Eigen::MatrixXd::Ones(n, 1), columns, values, seed);
  CommonChange change{.is_step = look.column < jumps.cols(),
                      .size = look.values[1],
                      .std_error = look.errors[1],
                      .p_value = std::min(1.0, look.p_value * static_cast<double>(looks)),
                      .gain = look.gain};
  change.gain.metric = "mean error of a scan";
  change.gain.unit = "m";
  if (change.p_value > kSignificantInSeries) return std::nullopt;
  const double by_step = squares_left(jumps, values);
  const double by_creeping = squares_left(columns.rightCols(columns.cols() - jumps.cols()), values);
  change.log10_odds =
      log10_odds_of(change.is_step ? by_step : by_creeping, change.is_step ? by_creeping : by_step,
                    squares_left(Eigen::MatrixXd(n, 0), values), static_cast<double>(n));
  if (change.is_step) {
    const auto first = static_cast<std::size_t>(before_step(columns.col(look.column)));
    change.shape = seconds[first];
    change.shape_error = seconds[first] - seconds[first - 1];
  } else {
    change.shape = kWarmUps[static_cast<std::size_t>(look.column - jumps.cols())] * time[n - 1];
    change.shape_error = change.shape;  // known to a factor
  }
  return change;
}

Plot change_plot(const std::string& name, const CommonChange& change, const RangeErrors& errors,
                 const std::vector<double>& seconds) {
  const Eigen::VectorXd values = means(errors, seconds.size());
  PlotSeries measured{.name = "measured", .x = {}, .y = {}, .joined = false};
  PlotSeries found{.name = "found", .x = {}, .y = {}};
  double middle = 0;  // of what was found: errors are about the mean of their beams
  for (const double second : seconds) middle += at(change, second) / static_cast<double>(seconds.size());
  for (std::size_t scan = 0; scan < seconds.size(); ++scan) {
    measured.x.push_back(seconds[scan]);
    measured.y.push_back(1e3 * values[static_cast<Eigen::Index>(scan)]);
    found.x.push_back(seconds[scan]);
    found.y.push_back(1e3 * (at(change, seconds[scan]) - middle));
  }
  return {.title = name + ": all beams together",
          .x_label = "time since the run's epoch [s]",
          .y_label = "mean error of a scan [mm]",
          .series = {std::move(measured), std::move(found)}};
}

void take_out(const CommonChange& change, const std::vector<double>& seconds, RangeErrors& errors) {
  std::vector<double> sums;
  std::vector<double> counts;
  for (std::size_t i = 0; i < errors.size(); ++i) {
    const std::size_t beam = errors.beam[i];
    if (beam >= sums.size()) {
      sums.resize(beam + 1);
      counts.resize(beam + 1);
    }
    errors.value[i] -= static_cast<float>(at(change, seconds[errors.block[i]]));
    sums[beam] += double{errors.value[i]};
    counts[beam] += 1;
  }
  for (std::size_t i = 0; i < errors.size(); ++i) {
    errors.value[i] -= static_cast<float>(sums[errors.beam[i]] / counts[errors.beam[i]]);
  }
}

}  // namespace crisp
