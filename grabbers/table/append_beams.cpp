// SPDX-License-Identifier: BSD-3-Clause
#include "grabbers/table/append_beams.hpp"

#include "pipeline/data/mirror_angle.hpp"

namespace crisp {

void append_beams(const BeamSequence& sequence, std::span<const float> ranges,
                  std::span<const float> remissions, Measurements& to) {
  for (std::size_t k = 0; k < ranges.size(); ++k) {
    if (!(ranges[k] > 0)) continue;
    const auto n = static_cast<double>(k);
    to.range.push_back(ranges[k]);
    to.mirror_angle.push_back(
        static_cast<float>(wrapped_mirror_angle(sequence.first_angle + n * sequence.angle_step)));
    to.time.push_back(sequence.first_time + n * sequence.interval);
    to.laser.push_back(sequence.laser);
    to.remission.push_back(remissions.empty() ? 0.0F : remissions[k]);
    to.beam.push_back(static_cast<std::uint16_t>(k));
  }
}

}  // namespace crisp
