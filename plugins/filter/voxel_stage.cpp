// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/filter/voxel_stage.hpp"

#include "pipeline/data/cloud.hpp"

namespace crisp {

void VoxelStage::describe(StageDescription<VoxelStage>& d) {
  d.name("filter.voxel").summary("thins the cloud to one point in each cell of a grid");
  d.details(
      "The first point in each cell stays as it was measured, with its time, laser and beam; no mean is "
      "taken. "
      "The grid is one for all clouds that come, so that memory grows with the surface that was seen, not "
      "with "
      "the recording.");
  d.takes<Cloud>().gives<Cloud>();
  d.option("size", &VoxelStage::size_, "edge of a cell").unit("m").range(1e-4, 100);
}

void VoxelStage::process(const Inputs& in, Outputs& out, Context& context) {
  if (!voxels_) voxels_.emplace(size_);
  const Cloud& cloud = in.get<Cloud>();
  Cloud thinned;
  thinned.header = cloud.header;
  for (const Point& point : cloud) {
    if (voxels_->is_first(point.x, point.y, point.z)) thinned.push_back(point);
  }
  context.count("points in a cell that had one", cloud.size() - thinned.size());
  out.give(std::move(thinned));
}

}  // namespace crisp
