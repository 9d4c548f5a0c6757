// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/table/append_beams.hpp"

#include "pipeline/data/mirror_angle.hpp"

namespace crisp {

namespace {

void resize(Measurements& to, std::size_t n) {
  to.range.resize(n);
  to.mirror_angle.resize(n);
  to.time.resize(n);
  to.laser.resize(n);
  to.remission.resize(n);
  to.beam.resize(n);
}

}  // namespace

void append_beams(const BeamSequence& sequence, std::span<const BeamEchoes> echoes, Measurements& to) {
  std::size_t at = to.size();
  const std::size_t beams = echoes.empty() ? 0 : echoes.front().ranges.size();
  resize(to, at + echoes.size() * beams);
  for (std::size_t k = 0; k < beams; ++k) {
    const auto n = static_cast<double>(k);
    for (const auto& [ranges, remissions] : echoes) {
      if (!(ranges[k] > 0)) continue;
      to.range[at] = ranges[k];
      to.mirror_angle[at] =
          static_cast<float>(wrapped_mirror_angle(sequence.first_angle + n * sequence.angle_step));
      to.time[at] = sequence.first_time + n * sequence.interval;
      to.laser[at] = sequence.laser;
      to.remission[at] = remissions.empty() ? 0.0F : remissions[k];
      to.beam[at] = static_cast<std::uint16_t>(k);
      ++at;
    }
  }
  resize(to, at);
}

}  // namespace crisp
