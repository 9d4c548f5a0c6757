// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/estimate/placed_beams.hpp"

#include <algorithm>

#include <crisp/error.hpp>

#include "pipeline/data/recordings.hpp"
#include "pipeline/quality/blocks.hpp"

namespace crisp {
namespace {

/// [m] Between the places of recordings: farther than any beam goes.
constexpr double kApart = 1000;

Measurements lengthened(Measurements beams) {
  constexpr float kFurther = 1;  // [m]
  for (float& range : beams.range) range += kFurther;
  return beams;
}

}  // namespace

Vectors place_all(const SensorModel& model, const Measurements& beams, const PlateTrajectory& plate) {
  Vectors points;
  points.assign(beams.size(), 0);
  std::size_t placed = 0;
  model.place(beams, plate, [&](const PlacedRun& run) {
    const auto first = static_cast<std::ptrdiff_t>(run.first);
    std::ranges::copy(run.x, points.x.begin() + first);
    std::ranges::copy(run.y, points.y.begin() + first);
    std::ranges::copy(run.z, points.z.begin() + first);
    placed += run.x.size();
  });
  if (placed != beams.size()) {
    throw Error(
        "an eta moved some beams out of the time span of the encoder readings",
        "check the rig's eta, the clock stages, and whether the encoder was recorded from begin to end");
  }
  return points;
}

PlacedBeams::PlacedBeams(const SensorModel& model, const Sample& sample) {
  constexpr std::size_t kBlock = 8192;  // beams
  for_each_index(2, [&](std::size_t i) {
    if (i == 0) points_ = place_all(model, sample.beams, *sample.plate);
    if (i == 1) directions_ = place_all(model, lengthened(sample.beams), *sample.plate);
  });
  const std::size_t n = sample.beams.size();
  views_.resize(n);
  const RecordingNumbers recording(*sample.plate);
  for_blocks(n, kBlock, [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Eigen::Vector3d point(points_.x[i], points_.y[i], points_.z[i]);
      const Eigen::Vector3d further(directions_.x[i], directions_.y[i], directions_.z[i]);
      const Eigen::Vector3d direction = (further - point).normalized();
      directions_.x[i] = direction.x();
      directions_.y[i] = direction.y();
      directions_.z[i] = direction.z();
      points_.x[i] += static_cast<double>(recording.of(sample.beams.time[i])) * kApart;
      views_[i] = 2U * sample.beams.laser[i] + (sample.beams.mirror_angle[i] > 0 ? 1U : 0U);
    }
  });
}

}  // namespace crisp
