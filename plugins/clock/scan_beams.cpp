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
  out.range.resize(n);
  out.mirror_angle.resize(n);
  out.time.resize(n);
  out.laser.assign(n, scan.laser);
  out.remission.resize(n);
  out.beam.resize(n);
  const double first_time = timed.beam_time(0);
  const double time_step = scan.angle_step / kTurn * timed.period;
  const double first_angle = scan.start_angle - laser.mount;
  std::size_t i = 0;
  for (std::size_t k = 0; k < beams; ++k) {
    if (!came_back(ranges[k])) continue;
    const auto along = static_cast<double>(k);
    out.range[i] = ranges[k];
    out.mirror_angle[i] = static_cast<float>(first_angle + along * scan.angle_step);
    out.time[i] = first_time + along * time_step;
    if (k < remissions.size()) out.remission[i] = remissions[k];
    out.beam[i] = static_cast<std::uint16_t>(k);
    ++i;
  }
  return out;
}

}  // namespace crisp
