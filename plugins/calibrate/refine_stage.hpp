// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <crisp/clock_map.hpp>
#include <crisp/context.hpp>
#include <crisp/measure.hpp>
#include <crisp/stage.hpp>

#include "pipeline/data/oriented_plate.hpp"
#include "pipeline/estimate/measurement_buffer.hpp"
#include "pipeline/estimate/surfel_refinement.hpp"
#include "plugins/calibrate/rig_check.hpp"

namespace crisp::calibrate {

/// Refines a calibration by least squares against the data's flat surfaces.
class RefineStage final : public Stage {
 public:
  static void describe(StageDescription<RefineStage>& d);
  void check(const RunSettings& run) const override;
  void process(const Inputs& in, Outputs& out, Context& context) override;
  void finish(Outputs& out, Context& context) override;

 private:
  void judge(const estimate::Sample& sample, const estimate::Refinement& refined, Calibration& calibration,
             Context& context) const;

  /// Mistakes of the rig, as caveats: mounts always, the rest where views disagree, the scene may be folded,
  /// the rig is contradicted (`check`), or the data determine little.
  std::vector<std::string> mistakes(const estimate::Sample& sample, const estimate::Refinement& refined,
                                    const RigCheck& check, Measure& measure, Context& context) const;

  estimate::RefinementSettings settings_;
  double sigma_ = 0.02;  // [m] near the ranges' noise, where RQE itself is hardly biased
  data::OrientedPlate oriented_;
  estimate::MeasurementBuffer collected_;
  std::shared_ptr<const Calibration> start_;
  std::map<std::string, ClockMap> clocks_;  ///< by device
};

}  // namespace crisp::calibrate
