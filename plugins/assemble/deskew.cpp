// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/assemble/deskew.hpp"

namespace crisp {

Deskewed deskew(const Measurements& beams, const PlateTrajectory& plate, const SensorModel& model) {
  const Placed placed = model.place(beams, plate);
  auto cloud = std::make_shared<Cloud>();
  cloud->header.frame_id = "base";
  cloud->header.stamp = static_cast<std::uint64_t>(beams.epoch_ns / 1000);  // PCL's stamps are microseconds
  cloud->points.resize(placed.index.size());
  for (std::size_t i = 0; i < placed.index.size(); ++i) {
    const auto measurement = placed.index[i];
    Point& point = cloud->points[i];
    point.getVector3fMap() = placed.points.col(static_cast<Eigen::Index>(i)).cast<float>();
    point.intensity = beams.remission[measurement];
    point.laser = beams.laser[measurement];
    point.beam = beams.beam[measurement];
    point.time = beams.time[measurement];
  }
  cloud->width = static_cast<std::uint32_t>(cloud->points.size());
  cloud->height = 1;
  return {.cloud = std::move(cloud), .outside = beams.size() - placed.index.size()};
}

}  // namespace crisp
