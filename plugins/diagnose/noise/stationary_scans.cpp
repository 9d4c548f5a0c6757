// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/diagnose/noise/stationary_scans.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "pipeline/statistics/robust_estimators.hpp"

namespace crisp::diagnose {
namespace {

constexpr double kMaxSpread = 0.03;  // [m]

}  // namespace

void StationaryScans::add(const Scan& scan) {
  constexpr std::size_t kMaxScans = 4000;  // bounds the memory, and suffices for all tests
  const bool has_ranges = !scan.echoes.empty() && !scan.echoes.front().ranges.empty();
  if (!has_ranges || receipt_ns_.size() >= kMaxScans) {
    ++left_out_;
    return;
  }
  const auto& ranges = scan.echoes.front().ranges;
  if (receipt_ns_.empty()) beams_ = ranges.size();
  if (ranges.size() != beams_) {
    ++left_out_;
    return;
  }
  const auto& remissions = scan.echoes.front().remissions;
  const bool had_all = remissions_.size() == ranges_.size();
  ranges_.insert(ranges_.end(), ranges.begin(), ranges.end());
  if (had_all) remissions_.insert(remissions_.end(), remissions.begin(), remissions.end());
  if (remissions_.size() != ranges_.size()) remissions_.clear();
  receipt_ns_.push_back(scan.receipt_ns);
}

void PlateStandstill::add(const PlateReading& reading) {
  if (!first_) first_ = reading.count;
  const auto since = static_cast<std::int32_t>(reading.count - *first_);
  least_ = std::min(least_, since);
  most_ = std::max(most_, since);
}

bool PlateStandstill::turned() const {
  constexpr std::int64_t kShakes = 3;  // [encoder steps] jitter of a held plate
  return std::int64_t{most_} - least_ > kShakes;
}

std::vector<std::size_t> StationaryScans::shots_of(std::size_t beam) const {
  constexpr double kMinCame = 0.8;     // share of a beam's shots with an echo
  constexpr double kMinRange = 0.016;  // [m] smaller values are error codes
  std::vector<std::size_t> shots;
  for (std::size_t scan = 0; scan < scans(); ++scan) {
    if (range(scan, beam) > kMinRange && std::isfinite(range(scan, beam))) shots.push_back(scan);
  }
  if (static_cast<double>(shots.size()) < kMinCame * static_cast<double>(scans())) shots.clear();
  return shots;
}

FarShots StationaryScans::far_shots() const {
  constexpr double kFar = 8;          // standard deviations
  constexpr double kMaxAtOnce = 0.5;  // share of the beams
  FarShots far{.scans = scans(), .of_beam = std::vector<std::vector<std::uint32_t>>(beams_)};
  std::vector<double> shots_in(scans(), 0);
  std::vector<double> far_in(scans(), 0);
  for (std::size_t beam = 0; beam < beams_; ++beam) {
    const std::vector<std::size_t> shots = shots_of(beam);
    if (shots.empty()) continue;
    std::vector<double> ranges;
    for (const std::size_t scan : shots) ranges.push_back(range(scan, beam));
    const double middle = statistics::median_in_place(ranges);
    for (double& value : ranges) value = std::abs(value - middle);
    const double spread = statistics::kMadToSigma * statistics::median_in_place(ranges);
    if (spread > kMaxSpread) continue;
    far.shots += shots.size();
    for (const std::size_t scan : shots) {
      shots_in[scan] += 1;
      if (std::abs(range(scan, beam) - middle) < std::max(kMaxSpread, kFar * spread)) continue;
      far_in[scan] += 1;
      far.of_beam[beam].push_back(static_cast<std::uint32_t>(scan));
    }
  }
  for (auto& scans : far.of_beam) {
    std::erase_if(scans, [&](std::uint32_t scan) { return far_in[scan] > kMaxAtOnce * shots_in[scan]; });
  }
  return far;
}

std::variant<RangeErrors, InsufficientData> StationaryScans::errors(
    const std::vector<bool>& leave_out) const {
  constexpr std::size_t kMinScans = 10;
  constexpr double kMinStatic = 0.25;  // share of the beams with echoes
  if (scans() < kMinScans) {
    return InsufficientData{
        fmt::format("it sent only {} scans (at least {} are needed)", scans(), kMinScans)};
  }
  RangeErrors all;
  std::size_t steady = 0;
  std::size_t seen = 0;
  for (std::size_t beam = 0; beam < beams_; ++beam) {
    const std::vector<std::size_t> shots = shots_of(beam);
    if (shots.empty() || (!leave_out.empty() && leave_out[beam])) continue;
    double mean = 0;
    for (const std::size_t scan : shots) mean += range(scan, beam);
    mean /= static_cast<double>(shots.size());
    ++seen;
    std::vector<double> off;
    for (const std::size_t scan : shots) off.push_back(std::abs(range(scan, beam) - mean));
    if (statistics::kMadToSigma * statistics::median_in_place(off) > kMaxSpread) continue;
    ++steady;
    for (const std::size_t scan : shots) {
      all.value.push_back(static_cast<float>(range(scan, beam) - mean));
      all.range.push_back(static_cast<float>(mean));
      if (!remissions_.empty()) all.remission.push_back(remissions_[scan * beams_ + beam]);
      all.beam.push_back(static_cast<std::uint16_t>(beam));
      all.block.push_back(static_cast<std::uint32_t>(scan));
    }
  }
  if (seen == 0) return InsufficientData{"no beam has echoes in at least 80 % of the scans"};
  if (static_cast<double>(steady) < kMinStatic * static_cast<double>(seen) || steady == 0)
    return InsufficientData{"the laser or the whole scene moves"};
  return all;
}

}  // namespace crisp::diagnose
