// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include <crisp/context.hpp>
#include <crisp/stage.hpp>

#include "pipeline/data/oriented_plate.hpp"
#include "pipeline/estimate/measurement_buffer.hpp"
#include "plugins/calibrate/rqe_calibration.hpp"

namespace crisp::calibrate {

/// Calibrates by making the cloud as crisp as it can be.
class RqeStage final : public Stage {
 public:
  static void describe(StageDescription<RqeStage>& d);
  void check(const RunSettings& run) const override;
  void process(const Inputs& in, Outputs& out, Context& context) override;
  void finish(Outputs& out, Context& context) override;

 private:
  std::unique_ptr<Measure> make_measure(const RunSettings& run) const;
  /// Reports what contradicts the rig. Under `direction: auto` a calibration of the mirror image is
  /// corrected.
  Calibration compared_with_rig(Calibration calibration, Context& context) const;

  RqeCalibrationSettings settings_;
  estimate::ParameterPrior range_;
  std::vector<double> sigma_{0.2, 0.05};
  std::vector<double> in_plane_sigma_{0.5, 0.1};
  std::string measure_ = "rqe";
  MeasureSettings measure_settings_{.search = "grid", .cutoff = 5};
  data::OrientedPlate oriented_;
  estimate::MeasurementBuffer collected_;
  std::shared_ptr<const Calibration> start_;
};

}  // namespace crisp::calibrate
