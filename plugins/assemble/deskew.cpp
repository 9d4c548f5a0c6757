// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/assemble/deskew.hpp"

namespace crisp {

Deskewed deskew(const Measurements& beams, const PlateTrajectory& plate, const SensorModel& model,
                std::shared_ptr<Cloud> into) {
  const auto cloud = std::move(into);
  cloud->header.frame_id = "base";
  cloud->header.stamp = static_cast<std::uint64_t>(beams.epoch_ns / 1000);  // PCL's stamps are microseconds
  cloud->points.resize(beams.size());
  std::size_t placed = 0;
  model.place(beams, plate, [&](const PlacedRun& run) {
    for (std::size_t i = 0; i < run.index.size(); ++i) {
      const auto measurement = run.index[i];
      Point& point = cloud->points[placed++];
      point.x = static_cast<float>(run.x[i]);
      point.y = static_cast<float>(run.y[i]);
      point.z = static_cast<float>(run.z[i]);
      point.intensity = beams.remission[measurement];
      point.laser = beams.laser[measurement];
      point.beam = beams.beam[measurement];
      point.time = beams.time[measurement];
    }
  });
  cloud->points.resize(placed);
  cloud->width = static_cast<std::uint32_t>(placed);
  cloud->height = 1;
  return {.cloud = cloud, .outside = beams.size() - placed};
}

}  // namespace crisp
