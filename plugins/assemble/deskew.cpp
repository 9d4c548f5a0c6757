// SPDX-License-Identifier: BSD-3-Clause
#include <crisp/deskew.hpp>

#include "plugins/assemble/pack_points.hpp"

namespace crisp {

Deskewed deskew(const Measurements& beams, const PlateTrajectory& plate, const SensorModel& model,
                MirrorAngleCache& known, std::shared_ptr<Cloud> into) {
  const auto cloud = std::move(into);
  cloud->header.frame_id = "base";
  cloud->header.stamp = static_cast<std::uint64_t>(beams.epoch_ns / 1000);  // PCL's stamps are microseconds
  cloud->points.resize(beams.size());
  Point* points = cloud->points.data();
  const auto pack = [&](const PlacedRun& run) {
    simd::pack_points({.x = run.x.data(),
                       .y = run.y.data(),
                       .z = run.z.data(),
                       .intensity = &beams.remission[run.first],
                       .laser = &beams.laser[run.first],
                       .beam = &beams.beam[run.first],
                       .time = &beams.time[run.first],
                       .size = run.x.size()},
                      points);
    points += run.x.size();
  };
  model.place(beams, plate, pack, known);
  const auto placed = static_cast<std::size_t>(points - cloud->points.data());
  cloud->points.resize(placed);
  cloud->width = static_cast<std::uint32_t>(placed);
  cloud->height = 1;
  return {.cloud = cloud, .outside = beams.size() - placed};
}

}  // namespace crisp
