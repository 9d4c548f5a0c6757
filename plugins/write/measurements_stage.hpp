// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <optional>

#include <crisp/measurements.hpp>
#include <crisp/plate_trajectory.hpp>

#include "plugins/write/parts_options.hpp"

namespace crisp::write {

/// `write.measurements`: raw measurements and the plate's trajectory, from which `grabber.pcd` goes on.
class WriteMeasurementsStage final : public Stage {
 public:
  static void describe(StageDescription<WriteMeasurementsStage>& d);
  void process(const Inputs& in, Outputs& out, Context& context) override;
  void finish(Outputs& out, Context& context) override;

 private:
  void write_part(bool more);

  PartsOptions options_;
  std::optional<pcd::PartsWriter> writer_;
  Measurements pending_;
  std::shared_ptr<const PlateTrajectory> plate_;
  std::size_t written_ = 0;
};

}  // namespace crisp::write
