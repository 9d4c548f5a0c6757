// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/report/shown_cloud.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "pipeline/quality/spatial_order.hpp"
#include "plugins/report/local_planes.hpp"
#include "plugins/report/voxel_sampling.hpp"

namespace crisp::report {
namespace {

constexpr double kSide = 0.1;  // [m] of the cells that points are chosen from

/// NaN where the encoder readings do not cover a beam.
Vectors placed_or_nan(const SensorModel& model, const Measurements& beams, const PlateTrajectory& plate) {
  Vectors points;
  points.assign(beams.size(), std::numeric_limits<double>::quiet_NaN());
  model.place(beams, plate, [&](const PlacedRun& run) {
    const auto first = static_cast<std::ptrdiff_t>(run.first);
    std::ranges::copy(run.x, points.x.begin() + first);
    std::ranges::copy(run.y, points.y.begin() + first);
    std::ranges::copy(run.z, points.z.begin() + first);
  });
  return points;
}

Vectors picked(const Vectors& from, const std::vector<std::uint32_t>& chosen) {
  Vectors some;
  some.assign(chosen.size(), 0);
  for (std::size_t k = 0; k < chosen.size(); ++k) {
    some.x[k] = from.x[chosen[k]];
    some.y[k] = from.y[chosen[k]];
    some.z[k] = from.z[chosen[k]];
  }
  return some;
}

std::vector<std::uint32_t> placed_in_both(const Vectors& one, const Vectors& other) {
  std::vector<std::uint32_t> both;
  for (std::uint32_t i = 0; i < one.size(); ++i) {
    if (std::isfinite(one.x[i]) && std::isfinite(other.x[i])) both.push_back(i);
  }
  return both;
}

std::vector<double> distances(const LocalPlanes& planes, const PointsView& points,
                              const std::vector<std::uint32_t>& chosen) {
  std::vector<double> all;
  all.reserve(chosen.size());
  for (const std::uint32_t i : chosen) all.push_back(planes.distance(i, points));
  return all;
}

/// From the laser to the point, of the beams `of`: a beam a metre longer ends farther along it.
Vectors directions(const SensorModel& model, Measurements beams, const PlateTrajectory& plate) {
  constexpr float kLonger = 1;  // [m]
  const Vectors points = placed_or_nan(model, beams, plate);
  for (float& range : beams.range) range += kLonger;
  Vectors farther = placed_or_nan(model, beams, plate);
  for (std::size_t i = 0; i < farther.size(); ++i) {
    farther.x[i] -= points.x[i];
    farther.y[i] -= points.y[i];
    farther.z[i] -= points.z[i];
  }
  return farther;
}

}  // namespace

ShownCloud shown_cloud(const estimate::Sample& sample, const SensorModel& before, const SensorModel& after,
                       std::size_t count) {
  const Vectors all_before = placed_or_nan(before, sample.beams, *sample.plate);
  const Vectors all_after = placed_or_nan(after, sample.beams, *sample.plate);
  const std::vector<std::uint32_t> covered_beams = placed_in_both(all_before, all_after);
  const Vectors points = picked(all_after, covered_beams), points_before = picked(all_before, covered_beams);
  const quality::SpatialOrder order = quality::spatial_order(points.view(), kSide);
  const LocalPlanes planes = local_planes(points.view(), order);
  const LocalPlanes planes_before =
      local_planes(points_before.view(), quality::spatial_order(points_before.view(), kSide));
  const std::vector<std::uint32_t> chosen = voxel_sample(order, count);

  ShownCloud shown{.before = picked(points_before, chosen),
                   .after = picked(points, chosen),
                   .distance = distances(planes, points.view(), chosen),
                   .distance_before = distances(planes_before, points_before.view(), chosen),
                   .of = covered_beams.size()};
  Measurements beams{.epoch_ns = sample.beams.epoch_ns};
  beams.reserve(chosen.size());
  for (const std::uint32_t i : chosen) beams.append(sample.beams, covered_beams[i]);
  const Vectors along = directions(after, beams, *sample.plate);
  for (std::size_t k = 0; k < chosen.size(); ++k) {
    shown.incidence.push_back(planes.incidence(chosen[k], {along.x[k], along.y[k], along.z[k]}));
  }
  shown.range.assign(beams.range.begin(), beams.range.end());
  shown.laser = std::move(beams.laser);
  shown.beam = std::move(beams.beam);
  shown.remission = std::move(beams.remission);
  shown.time = std::move(beams.time);
  return shown;
}

ShownCloud shown_cloud(const Cloud& cloud, std::size_t count) {
  Vectors points;
  for (const Point& point : cloud) {
    points.x.push_back(double{point.x});
    points.y.push_back(double{point.y});
    points.z.push_back(double{point.z});
  }
  const quality::SpatialOrder order = quality::spatial_order(points.view(), kSide);
  const LocalPlanes planes = local_planes(points.view(), order);
  const std::vector<std::uint32_t> chosen = voxel_sample(order, count);
  ShownCloud shown{.after = picked(points, chosen),
                   .distance = distances(planes, points.view(), chosen),
                   .of = cloud.size()};
  for (const std::uint32_t i : chosen) {
    shown.laser.push_back(cloud[i].laser);
    shown.beam.push_back(cloud[i].beam);
    shown.remission.push_back(cloud[i].intensity);
    shown.time.push_back(cloud[i].time);
  }
  return shown;
}

}  // namespace crisp::report
