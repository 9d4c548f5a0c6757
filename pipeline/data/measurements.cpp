// SPDX-License-Identifier: BSD-3-Clause
#include <crisp/measurements.hpp>

#include "pipeline/data/internal_error.hpp"

namespace crisp {

void Measurements::reserve(std::size_t n) {
  range.reserve(n);
  mirror_angle.reserve(n);
  time.reserve(n);
  laser.reserve(n);
  remission.reserve(n);
  beam.reserve(n);
}

void Measurements::append(const Measurements& other) {
  if (range.empty()) epoch_ns = other.epoch_ns;
  if (epoch_ns != other.epoch_ns)
    throw data::internal_error("measurements of different epochs cannot be joined");
  const bool incidences = (size() == 0 || !cos_incidence.empty()) && !other.cos_incidence.empty();
  const auto join = [](auto& to, const auto& from) { to.insert(to.end(), from.begin(), from.end()); };
  join(range, other.range);
  join(mirror_angle, other.mirror_angle);
  join(time, other.time);
  join(laser, other.laser);
  join(remission, other.remission);
  join(beam, other.beam);
  if (other.size() == 0) return;
  join(cos_incidence, other.cos_incidence);
  if (!incidences) cos_incidence.clear();
}

}  // namespace crisp
