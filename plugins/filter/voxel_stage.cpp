// SPDX-License-Identifier: BSD-3-Clause
#include "plugins/filter/voxel_stage.hpp"

#include <fmt/format.h>

#include <cmath>

#include <crisp/cloud.hpp>

namespace crisp::filter {

void VoxelStage::describe(StageDescription<VoxelStage>& d) {
  d.name("filter.voxel").summary("thins the cloud to one point in each cell of a grid");
  d.details(
      "Keeps the first point in each cell as measured, with its time, laser and beam, and not a mean. All incoming clouds share one grid, so that memory grows with the seen surface, not with the recording. The grid extends 2^31 cells from the origin; points beyond are counted, with a warning.");
  d.takes<Cloud>().gives<Cloud>();
  d.option("size", &VoxelStage::size_, "edge length of a cell").unit("m").range(1e-4, 100);
}

void VoxelStage::process(const Inputs& in, Outputs& out, Context& context) {
  if (!voxels_) voxels_.emplace(size_);
  const Cloud& cloud = in.get<Cloud>();
  Cloud thinned;
  thinned.header = cloud.header;
  std::size_t too_far = 0, nowhere = 0;
  for (const Point& point : cloud) {
    const InVoxel found = voxels_->put(point.x, point.y, point.z);
    if (found == InVoxel::first) thinned.push_back(point);
    if (found == InVoxel::too_far) ++too_far;
    if (found == InVoxel::nowhere) ++nowhere;
  }
  too_far_ += too_far;
  context.count("points in occupied cells", cloud.size() - thinned.size() - too_far - nowhere);
  context.count("points outside of the grid", too_far);
  context.count("points with a coordinate that is no number", nowhere);
  out.give(std::move(thinned));
}

void VoxelStage::finish(Outputs&, Context& context) {
  if (too_far_ == 0) return;
  context.warn(fmt::format(
      "{} points are dropped that are {:.3g} km or more from the origin, beyond the grid's 2^31 cells: give a larger size, remove outliers by filter.crop above, or subtract a shift (grabber.cloud)",
      too_far_, std::ldexp(size_, 31) / 1000));
}

}  // namespace crisp::filter
