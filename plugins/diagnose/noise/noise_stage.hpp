// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <crisp/context.hpp>
#include <crisp/findings.hpp>
#include <crisp/stage.hpp>

#include "plugins/diagnose/noise/goodness_of_fit.hpp"
#include "plugins/diagnose/noise/stationary_scans.hpp"

namespace crisp::diagnose {

/// Stage `diagnose.noise`: estimates the range noise of stationary lasers and their common-mode errors.
class DiagnoseNoiseStage final : public Stage {
 public:
  static void describe(StageDescription<DiagnoseNoiseStage>& d);
  void process(const Inputs& in, Outputs& out, Context& context) override;
  void finish(Outputs& out, Context& context) override;

 private:
  void add_laser(const std::string& name, const StationaryScans& scans, Findings& all, Context& context);

  std::optional<std::filesystem::path> folder_;
  std::vector<StationaryScans> lasers_;  // of the rig
  PlateStandstill plate_;
  std::int64_t first_ns_ = 0;  // receipt time of the first scan
  std::vector<data::GoodnessOfFit> reported_;
  Findings all_;  // including those of earlier stages
};

}  // namespace crisp::diagnose
