// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/clock/scan_beams.hpp"

#include <algorithm>
#include <limits>
#include <numbers>

namespace crisp {
namespace {

constexpr double kFirstPossible =
    -std::numbers::pi / 4;  // [rad] where a sweep begins, whatever is output of it
constexpr double kTurn = 2 * std::numbers::pi;
constexpr std::size_t kMostBeams = std::numeric_limits<std::uint16_t>::max() + std::size_t{1};

}  // namespace

double TimedScan::beam_time(std::size_t k) const {
  const double angle = scan->start_angle + static_cast<double>(k) * scan->angle_step;
  return begin + (angle - kFirstPossible) / kTurn * period;
}

Measurements measurements_of(const TimedScan& timed, const RigLaser& laser, std::int64_t epoch_ns) {
  const Scan& scan = *timed.scan;
  const auto& ranges = scan.echoes.front().ranges;
  const auto& remissions = scan.echoes.front().remissions;
  const std::size_t beams = std::min(ranges.size(), kMostBeams);
  const auto came_back = [](float range) {
    return range > 0 && range < std::numeric_limits<float>::infinity();
  };
  const auto n = static_cast<std::size_t>(
      std::count_if(ranges.begin(), ranges.begin() + static_cast<std::ptrdiff_t>(beams), came_back));

  Measurements out;
  out.epoch_ns = epoch_ns;
  out.beam.resize(n);
  std::size_t i = 0;
  for (std::size_t k = 0; k < beams && i < n; ++k) {
    out.beam[i] = static_cast<std::uint16_t>(k);
    i += came_back(ranges[k]) ? 1 : 0;
  }
  const auto of_beams = [&](auto& values, auto&& value_of) {
    values.resize(n);
    for (std::size_t j = 0; j < n; ++j) values[j] = value_of(out.beam[j]);
  };
  const double first_time = timed.beam_time(0);
  const double time_step = scan.angle_step / kTurn * timed.period;
  const double first_angle = scan.start_angle - laser.mount;
  const double angle_step = scan.angle_step;
  of_beams(out.range, [&](std::uint16_t k) { return ranges[k]; });
  of_beams(out.mirror_angle,
           [=](std::uint16_t k) { return static_cast<float>(first_angle + k * angle_step); });
  of_beams(out.time, [=](std::uint16_t k) { return first_time + k * time_step; });
  out.laser.assign(n, scan.laser);
  const bool complete = remissions.size() >= beams;
  if (complete) of_beams(out.remission, [&](std::uint16_t k) { return remissions[k]; });
  out.remission.resize(n);
  return out;
}

}  // namespace crisp
