// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

#include <crisp/context.hpp>
#include <crisp/measurements.hpp>
#include <crisp/pcd_table.hpp>
#include <crisp/plate_trajectory.hpp>
#include <crisp/stage.hpp>

namespace crisp::pcd_grabber {

/// `grabber.pcd`: raw measurements that an earlier run wrote, so that a run can stop and go on between
/// stages.
class GrabMeasurementsStage final : public Stage {
 public:
  static void describe(StageDescription<GrabMeasurementsStage>& d);
  void process(const Inputs& in, Outputs& out, Context& context) override;

 private:
  PlateTrajectory trajectory(const PcdTable& table, const std::filesystem::path& file,
                             Context& context) const;

  std::filesystem::path file_;
  double max_gap_ = 0.1;
};

}  // namespace crisp::pcd_grabber
