// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <crisp/context.hpp>
#include <crisp/measurements.hpp>
#include <crisp/stage.hpp>

#include "plugins/diagnose/scans/passes.hpp"

namespace crisp::diagnose {

/// Text report of the comparison of two passes; numbers that were not estimated are "unknown".
///
/// @param step   [rad] of the actuator
/// @param beams  number of compared beams
std::string in_words(const std::string& laser, const PassOffset& found, double step, std::size_t beams);

/// Stage `diagnose.passes`: tests an actuator for hysteresis between its passes in either direction.
class DiagnosePassesStage final : public Stage {
 public:
  static void describe(StageDescription<DiagnosePassesStage>& d);

  void process(const Inputs& in, Outputs& out, Context& context) override;
  void finish(Outputs& out, Context& context) override;

 private:
  double diagnose(Findings& findings, Context& context) const;

  std::optional<std::filesystem::path> folder_;
  double shortest_ = 0.05;
  bool correct_ = true;
  ScanSeries series_;
  Findings findings_;  // including those of earlier stages
  std::shared_ptr<const PlateTrajectory> plate_;
  std::vector<std::shared_ptr<const Measurements>> beams_;
};

}  // namespace crisp::diagnose
