// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/clock/scan_beams.hpp"

#include <algorithm>
#include <limits>
#include <numbers>
#include <span>

#include "pipeline/data/mirror_angle.hpp"

namespace crisp::clock {
namespace {

constexpr double kFirstPossible =
    -std::numbers::pi / 4;  // [rad] where a sweep begins, whatever is output of it
constexpr double kTurn = 2 * std::numbers::pi;
constexpr std::size_t kMaxBeams = std::numeric_limits<std::uint16_t>::max() + std::size_t{1};

bool came_back(float range) { return (range > 0) & (range < std::numeric_limits<float>::infinity()); }

/// Up to where all beams from k on came back.
std::size_t run_end(std::span<const float> ranges, std::size_t k) {
  constexpr std::size_t kStep = 32;  // processed without a branch: vectorized
  for (; k + kStep <= ranges.size(); k += kStep) {
    unsigned back = 1;
    for (std::size_t i = k; i < k + kStep; ++i) back &= static_cast<unsigned>(came_back(ranges[i]));
    if (back == 0) break;
  }
  while (k < ranges.size() && came_back(ranges[k])) ++k;
  return k;
}

void resize(Measurements& measurements, std::size_t n) {
  measurements.range.resize(n);
  measurements.mirror_angle.resize(n);
  measurements.time.resize(n);
  measurements.laser.resize(n);
  measurements.remission.resize(n);
  measurements.beam.resize(n);
}

template <class T, class Value>
void for_each_of(std::int32_t count, T* to, Value value) {
  for (std::int32_t i = 0; i < count; ++i) to[i] = static_cast<T>(value(i));
}

/// All echoes of each beam.
void append_echoes(const std::vector<Echo>& echoes, std::size_t beams, Measurements& out) {
  for (std::size_t k = 0; k < beams; ++k) {
    for (const Echo& echo : echoes) {
      if (!came_back(echo.ranges[k])) continue;
      out.range.push_back(echo.ranges[k]);
      out.remission.push_back(k < echo.remissions.size() ? echo.remissions[k] : 0);
      out.beam.push_back(static_cast<std::uint16_t>(k));
    }
  }
}

/// Fills the measurements of a scan of several echoes.
void fill_echoes(const TimedScan& timed, const RigLaser& laser, Measurements& out) {
  const Scan& scan = *timed.scan;
  resize(out, 0);
  append_echoes(scan.echoes, std::min(scan.echoes.front().ranges.size(), kMaxBeams), out);
  for (const std::uint16_t k : out.beam) {
    out.mirror_angle.push_back(
        static_cast<float>(data::wrapped_mirror_angle(scan.start_angle - laser.mount + k * scan.angle_step)));
    out.time.push_back(timed.beam_time(k));
  }
  out.laser.assign(out.size(), scan.laser);
}

}  // namespace

double TimedScan::beam_interval() const {
  return scan->timing == BeamTiming::stated ? scan->beam_interval : scan->angle_step / kTurn * period;
}

double TimedScan::beam_time(std::size_t k) const {
  if (scan->timing == BeamTiming::stated) return begin + static_cast<double>(k) * scan->beam_interval;
  const double angle = scan->start_angle + static_cast<double>(k) * scan->angle_step;
  return begin + (angle - kFirstPossible) / kTurn * period;
}

void fill_measurements(const TimedScan& timed, const RigLaser& laser, std::int64_t epoch_ns,
                       Measurements& out) {
  const Scan& scan = *timed.scan;
  const auto& remissions = scan.echoes.front().remissions;
  const auto& all = scan.echoes.front().ranges;
  const std::size_t beams = std::min(all.size(), kMaxBeams);
  const std::span ranges(all.data(), beams);
  const bool has_remissions = remissions.size() >= beams;
  const double first_time = timed.beam_time(0);
  const double time_step = timed.beam_interval();
  const double first_angle = scan.start_angle - laser.mount;

  out.epoch_ns = epoch_ns;
  out.cos_incidence.clear();
  if (scan.echoes.size() > 1) return fill_echoes(timed, laser, out);
  resize(out, beams);
  std::size_t n = 0;
  for (std::size_t k = 0; k < beams; ++k) {
    if (!came_back(ranges[k])) continue;
    const std::size_t end = run_end(ranges, k);
    // all that came back one after the other go together: array by array, as vectors
    const auto first = static_cast<std::int32_t>(k);
    const auto count = static_cast<std::int32_t>(end - k);
    std::copy_n(&ranges[k], count, &out.range[n]);
    if (has_remissions) std::copy_n(&remissions[k], count, &out.remission[n]);
    for_each_of(count, &out.beam[n], [=](std::int32_t i) { return first + i; });
    for_each_of(count, &out.mirror_angle[n], [=, step = scan.angle_step](std::int32_t i) {
      return data::wrapped_mirror_angle(first_angle + (first + i) * step);
    });
    for_each_of(count, &out.time[n], [=](std::int32_t i) { return first_time + (first + i) * time_step; });
    n += end - k;
    k = end;
  }
  resize(out, n);
  std::fill(out.laser.begin(), out.laser.end(), scan.laser);
  if (!has_remissions) std::fill(out.remission.begin(), out.remission.end(), 0.0F);
}

}  // namespace crisp::clock
