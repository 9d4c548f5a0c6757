// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/estimate/placed_beams.hpp"

#include "pipeline/data/error.hpp"
#include "pipeline/data/recordings.hpp"

namespace crisp {
namespace {

/// [m] Between the places of recordings: farther than any beam goes.
constexpr double kApart = 1000;

Placed place_all(const SensorModel& model, const Measurements& beams, const PlateTrajectory& plate) {
  Placed placed = model.place(beams, plate);
  if (placed.index.size() != beams.size()) {
    throw Error("the calibration's sample holds beams that the plate's readings do not cover");
  }
  return placed;
}

void set(Vectors& vectors, std::size_t i, const Eigen::Vector3d& value) {
  vectors.x[i] = value.x();
  vectors.y[i] = value.y();
  vectors.z[i] = value.z();
}

}  // namespace

PlacedBeams::PlacedBeams(const SensorModel& model, const Sample& sample) {
  constexpr float kFurther = 1;  // [m]
  Measurements further = sample.beams;
  for (float& range : further.range) range += kFurther;
  const Placed near = place_all(model, sample.beams, *sample.plate);
  const Placed far = place_all(model, further, *sample.plate);
  const std::size_t n = sample.beams.size();
  points_.assign(n, 0);
  directions_.assign(n, 0);
  views_.resize(n);
  const RecordingNumbers recording(*sample.plate);
  for (std::size_t i = 0; i < n; ++i) {
    const Eigen::Vector3d point = near.points.col(static_cast<Eigen::Index>(i));
    const auto place = static_cast<double>(recording.of(sample.beams.time[i]));
    set(points_, i, point + Eigen::Vector3d(place * kApart, 0, 0));
    set(directions_, i, (far.points.col(static_cast<Eigen::Index>(i)) - point).normalized());
    views_[i] = 2U * sample.beams.laser[i] + (sample.beams.mirror_angle[i] > 0 ? 1U : 0U);
  }
}

}  // namespace crisp
