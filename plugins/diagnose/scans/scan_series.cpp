// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/diagnose/scans/scan_series.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include <crisp/error.hpp>

namespace crisp::diagnose {

double ScanSeries::since_first(std::int64_t ns) {
  if (!first_ns_) first_ns_ = ns;
  return 1e-9 * static_cast<double>(ns - *first_ns_);
}

void ScanSeries::add(std::shared_ptr<const Scan> scan) {
  if (scan->echoes.empty() || scan->echoes.front().ranges.empty()) return;
  SeriesScan next{.receipt = since_first(scan->receipt_ns)};
  if (!scans_.empty()) {
    const SeriesScan& last = scans_.back();
    const auto on = static_cast<std::int16_t>(scan->scan_counter - last.scan->scan_counter);
    const auto us = static_cast<std::int32_t>(scan->scan_time_us - last.scan->scan_time_us);
    next.count = last.count + on;
    next.stamp = last.stamp + 1e-6 * us;
  }
  next.scan = std::move(scan);
  scans_.push_back(std::move(next));
}

void ScanSeries::add(const PlateReading& reading) {
  const double time = since_first(reading.receipt_ns);
  if (!times_.empty() && time <= times_.back()) return;
  const auto last = counts_.empty() ? std::int64_t{0} : counts_.back();
  const auto on = static_cast<std::int32_t>(reading.count - static_cast<std::uint32_t>(last));
  times_.push_back(time);
  counts_.push_back(last + on);
}

Error no_actuated_scans() {
  return Error("no scans with actuator readings arrived",
               "check by crisp info that the recording holds scans and actuator readings");
}

PlateTrajectory ScanSeries::actuator(const RigPlate& plate) const {
  if (times_.size() < 2)
    throw Error(fmt::format("{} actuator readings at different times arrived", times_.size()),
                "check that the actuator was recorded together with the laser");
  std::vector<double> angles;
  angles.reserve(counts_.size());
  const double step = plate.angle_per_count();
  for (const auto count : counts_) angles.push_back(static_cast<double>(count) * step);
  return {first_ns_.value_or(0), times_, std::move(angles), std::numeric_limits<double>::max()};
}

std::vector<SeriesScan> ScanSeries::stationary(const RigPlate& plate) const {
  constexpr double kAround = 0.25;  // [s]
  constexpr double kOfABeam = 0.02, kMinSteps = 2;
  const double step = std::abs(plate.angle_per_count());
  std::vector<SeriesScan> still;
  for (const auto& scan : scans_) {
    const auto begin = std::lower_bound(times_.begin(), times_.end(), scan.receipt - kAround);
    const auto end = std::upper_bound(times_.begin(), times_.end(), scan.receipt + kAround);
    if (begin == end) continue;
    const auto [least, most] = std::minmax_element(counts_.begin() + (begin - times_.begin()),
                                                   counts_.begin() + (end - times_.begin()));
    const double still_steps = std::max(kMinSteps, kOfABeam * std::abs(scan.scan->angle_step) / step);
    if (static_cast<double>(*most - *least) <= still_steps) still.push_back(scan);
  }
  return still;
}

std::vector<double> ScanSeries::stamped(const ClockMap& map) const {
  std::vector<double> times;
  double least_delay = std::numeric_limits<double>::infinity();
  for (const auto& scan : scans_) {
    times.push_back(map.to_hub(scan.stamp));
    least_delay = std::min(least_delay, scan.receipt - times.back());
  }
  for (double& time : times) time += least_delay;
  return times;
}

}  // namespace crisp::diagnose
