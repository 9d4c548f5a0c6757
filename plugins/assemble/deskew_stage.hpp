// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <crisp/calibration.hpp>
#include <crisp/cloud.hpp>
#include <crisp/context.hpp>
#include <crisp/sensor_model.hpp>
#include <crisp/stage.hpp>

#include "pipeline/data/oriented_plate.hpp"
#include "pipeline/data/pool.hpp"

namespace crisp::assemble {

/// `assemble.deskew`: measurements to points, under the calibration that comes from above, or else the rig's
/// nominal values.
class DeskewStage final : public Stage {
 public:
  static void describe(StageDescription<DeskewStage>& d);
  void process(const Inputs& in, Outputs& out, Context& context) override;
  void finish(Outputs& out, Context& context) override;

 private:
  const SensorModel& model(std::shared_ptr<const Calibration> calibration, const RunSettings& run);

  std::shared_ptr<const Calibration> calibration_;  ///< from above, of `model_`; null: the nominal one
  std::optional<SensorModel> model_;
  std::vector<std::string> with_incidence_;  ///< terms of it that depend on the beams' incidence
  std::vector<std::string> blind_;           ///< those whose beams have no known incidence
  data::OrientedPlate oriented_;
  MirrorAngleCache mirrors_;
  data::Pool<Cloud> clouds_;
  std::uint64_t beams_ = 0;
  std::uint64_t outside_ = 0;
};

}  // namespace crisp::assemble
