// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/estimate/surface_map.hpp"

#include <algorithm>
#include <cstddef>
#include <utility>

namespace crisp::estimate {
namespace {

constexpr std::uint32_t kNotThere = ~std::uint32_t{0};

/// The beams' numbers, laser by laser.
std::vector<std::vector<std::uint32_t>> by_laser(const std::vector<std::uint16_t>& laser) {
  std::vector<std::vector<std::uint32_t>> beams;
  for (std::uint32_t i = 0; i < laser.size(); ++i) {
    if (laser[i] >= beams.size()) beams.resize(laser[i] + std::size_t{1});
    beams[laser[i]].push_back(i);
  }
  return beams;
}

}  // namespace

SurfaceMap::SurfaceMap(const Measurements& beams, quality::Surfels surfels, std::vector<float> noise)
    : time_(beams.time), laser_(beams.laser), surfels_(std::move(surfels)), noise_(std::move(noise)) {}

SurfaceMap::Selection SurfaceMap::of(const Measurements& beams) const {
  // No laser fires two beams at one time.
  std::vector<std::uint32_t> number(time_.size(), kNotThere);
  const auto own = by_laser(laser_);
  const auto others = by_laser(beams.laser);
  for (std::size_t laser = 0; laser < std::min(own.size(), others.size()); ++laser) {
    auto other = others[laser].begin();
    for (const std::uint32_t i : own[laser]) {
      while (other != others[laser].end() && beams.time[*other] < time_[i]) ++other;
      if (other != others[laser].end() && beams.time[*other] == time_[i]) number[i] = *other;
    }
  }
  Selection selection;
  for (quality::Surfel surfel : surfels_.surfels) {
    const auto begin = static_cast<std::uint32_t>(selection.surfels.members.size());
    for (std::uint32_t k = surfel.begin; k < surfel.end; ++k) {
      const std::uint32_t beam = number[surfels_.members[k]];
      if (beam == kNotThere) continue;
      selection.surfels.members.push_back(beam);
      selection.surfels.weights.push_back(surfels_.weights[k]);
    }
    surfel.begin = begin;
    surfel.end = static_cast<std::uint32_t>(selection.surfels.members.size());
    if (surfel.end > surfel.begin) selection.surfels.surfels.push_back(surfel);
  }
  if (noise_.empty()) return selection;
  selection.noise.assign(beams.size(), 1);
  for (std::size_t i = 0; i < number.size(); ++i) {
    if (number[i] != kNotThere) selection.noise[number[i]] = noise_[i];
  }
  return selection;
}

}  // namespace crisp::estimate
