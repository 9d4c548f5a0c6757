// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/table/append_beams.hpp"

#include <algorithm>

#include "pipeline/data/mirror_angle.hpp"

namespace crisp::table {
namespace {

void resize(Measurements& to, std::size_t n) {
  to.range.resize(n);
  to.mirror_angle.resize(n);
  to.time.resize(n);
  to.laser.resize(n);
  to.remission.resize(n);
  to.beam.resize(n);
}

/// [rad] Angles of n beams in their order; wrapped only if one of them has to be.
void put_angles(const BeamSequence& sequence, std::size_t n, float* to) {
  const auto angle = [&](std::size_t k) {
    return sequence.first_angle + static_cast<double>(k) * sequence.angle_step;
  };
  const auto is_wrapped = [&](std::size_t k) { return data::wrapped_mirror_angle(angle(k)) == angle(k); };
  if (n == 0 || (is_wrapped(0) && is_wrapped(n - 1))) {
    for (std::size_t k = 0; k < n; ++k) to[k] = static_cast<float>(angle(k));
  } else {
    for (std::size_t k = 0; k < n; ++k) to[k] = static_cast<float>(data::wrapped_mirror_angle(angle(k)));
  }
}

/// Removes beams from index `at` on that did not come back.
void remove_no_echoes(std::size_t at, Measurements& from) {
  std::size_t kept = at;
  for (std::size_t k = at; k < from.size(); ++k) {
    if (!(from.range[k] > 0)) continue;
    from.range[kept] = from.range[k];
    from.mirror_angle[kept] = from.mirror_angle[k];
    from.time[kept] = from.time[k];
    from.remission[kept] = from.remission[k];
    from.beam[kept] = from.beam[k];
    ++kept;
  }
  resize(from, kept);
}

/// Adds beams of one echo each: column by column, which is quick.
void append_echo(const BeamSequence& sequence, const BeamEchoes& echo, Measurements& to) {
  const std::size_t at = to.size(), n = echo.ranges.size();
  resize(to, at + n);
  std::ranges::copy(echo.ranges, to.range.data() + at);
  if (!echo.remissions.empty()) std::ranges::copy(echo.remissions.first(n), to.remission.data() + at);
  put_angles(sequence, n, to.mirror_angle.data() + at);
  std::fill_n(to.laser.data() + at, n, sequence.laser);
  for (std::size_t k = 0; k < n; ++k) {
    to.time[at + k] = sequence.first_time + static_cast<double>(k) * sequence.interval;
    to.beam[at + k] = static_cast<std::uint16_t>(k);
  }
  if (!std::ranges::all_of(echo.ranges, [](float range) { return range > 0; })) remove_no_echoes(at, to);
}

}  // namespace

void append_beams(const BeamSequence& sequence, std::span<const BeamEchoes> echoes, Measurements& to) {
  if (echoes.size() == 1) return append_echo(sequence, echoes[0], to);
  std::size_t at = to.size();
  const std::size_t beams = echoes.empty() ? 0 : echoes.front().ranges.size();
  resize(to, at + echoes.size() * beams);
  for (std::size_t k = 0; k < beams; ++k) {
    const auto n = static_cast<double>(k);
    for (const auto& [ranges, remissions] : echoes) {
      if (!(ranges[k] > 0)) continue;
      to.range[at] = ranges[k];
      to.mirror_angle[at] =
          static_cast<float>(data::wrapped_mirror_angle(sequence.first_angle + n * sequence.angle_step));
      to.time[at] = sequence.first_time + n * sequence.interval;
      to.laser[at] = sequence.laser;
      to.remission[at] = remissions.empty() ? 0.0F : remissions[k];
      to.beam[at] = static_cast<std::uint16_t>(k);
      ++at;
    }
  }
  resize(to, at);
}

}  // namespace crisp::table
