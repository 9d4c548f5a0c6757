// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "pipeline/stage/context.hpp"
#include "pipeline/stage/description.hpp"
#include "plugins/filter/voxels.hpp"

namespace crisp {

/// `filter.voxel`: thins a cloud to one point in each cell of a grid.
class VoxelStage final : public Stage {
 public:
  static void describe(StageDescription<VoxelStage>& d);
  void process(const Inputs& in, Outputs& out, Context& context) override;
  void finish(Outputs& out, Context& context) override;

 private:
  double size_ = 0.05;
  std::optional<Voxels> voxels_;  ///< over all clouds that come
  std::size_t too_far_ = 0;
};

}  // namespace crisp
