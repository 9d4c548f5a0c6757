// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/estimate/placed_beams.hpp"

#include <Eigen/Geometry>
#include <algorithm>

#include "pipeline/data/recordings.hpp"
#include "pipeline/quality/blocks.hpp"

namespace crisp::estimate {
namespace {

/// [m] Between the places of recordings: farther than any beam goes.
constexpr double kApart = 1000;

Measurements lengthened(Measurements beams) {
  constexpr float kFurther = 1;  // [m]
  for (float& range : beams.range) range += kFurther;
  return beams;
}

Eigen::Vector3d at(const Vectors& vectors, std::size_t i) {
  return {vectors.x[i], vectors.y[i], vectors.z[i]};
}

void set(Vectors& vectors, std::size_t i, const Eigen::Vector3d& value) {
  vectors.x[i] = value.x();
  vectors.y[i] = value.y();
  vectors.z[i] = value.z();
}

Eigen::Matrix3Xd columns(const Vectors& vectors, const std::vector<std::size_t>& which) {
  Eigen::Matrix3Xd columns(3, static_cast<Eigen::Index>(which.size()));
  for (std::size_t k = 0; k < which.size(); ++k)
    columns.col(static_cast<Eigen::Index>(k)) = at(vectors, which[k]);
  return columns;
}

}  // namespace

UncoveredBeams::UncoveredBeams()
    : Error("an eta moved some beams out of the time span of the encoder readings",
            "check the rig's eta, the clock stages, and whether the encoder was recorded from begin to end") {
}

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
  if (placed != beams.size()) throw UncoveredBeams();
  return points;
}

PlacedBeams::PlacedBeams(const SensorModel& model, const Sample& sample) {
  constexpr std::size_t kBlock = 8192;  // beams
  quality::for_each_index(2, [&](std::size_t i) {
    if (i == 0) points_ = place_all(model, sample.beams, *sample.plate);
    if (i == 1) directions_ = place_all(model, lengthened(sample.beams), *sample.plate);
  });
  const std::size_t n = sample.beams.size();
  views_.resize(n);
  const data::RecordingNumbers recording(*sample.plate);
  quality::for_blocks(n, kBlock, [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Eigen::Vector3d way = at(directions_, i) - at(points_, i);
      set(directions_, i, way.normalized());
      points_.x[i] += static_cast<double>(recording.of(sample.beams.time[i])) * kApart;
      views_[i] = 2U * sample.beams.laser[i] + (sample.beams.mirror_angle[i] > 0 ? 1U : 0U);
    }
  });
}

void PlacedBeams::align_with(const PlacedBeams& other, const Sample& sample) {
  const data::RecordingNumbers recording(*sample.plate);
  std::vector<std::vector<std::size_t>> beams(recording.count());
  for (std::size_t i = 0; i < sample.beams.size(); ++i)
    beams[recording.of(sample.beams.time[i])].push_back(i);
  for (const std::vector<std::size_t>& of_one : beams) {
    if (of_one.empty()) continue;
    const Eigen::Matrix3Xd from = columns(points_, of_one);
    const Eigen::Isometry3d motion(Eigen::umeyama(from, columns(other.points_, of_one), false));
    for (const std::size_t i : of_one) {
      set(points_, i, motion * at(points_, i));
      set(directions_, i, motion.linear() * at(directions_, i));
    }
  }
}

}  // namespace crisp::estimate
