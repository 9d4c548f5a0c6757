// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "pipeline/data/measurements.hpp"
#include "pipeline/stage/context.hpp"
#include "pipeline/stage/description.hpp"
#include "plugins/scans/passes.hpp"

namespace crisp {

/// What two passes say of one another, for people; what could not be told is "unknown".
///
/// @param step   [rad] of the actuator
/// @param beams  that were compared
std::string in_words(const std::string& laser, const PassShift& found, double step, std::size_t beams);

/// `diagnose.passes`: whether the actuator is where it says on its way up and on its way down.
class DiagnosePassesStage final : public Stage {
 public:
  static void describe(StageDescription<DiagnosePassesStage>& d);

  void process(const Inputs& in, Outputs& out, Context& context) override;
  void finish(Outputs& out, Context& context) override;

 private:
  double diagnose(Findings& findings, Context& context) const;

  std::optional<std::filesystem::path> folder_;
  double shortest_ = 0.05;
  bool mend_ = true;
  ScanSeries series_;
  Findings findings_;  // what diagnoses above it said, and then its own
  std::shared_ptr<const PlateTrajectory> plate_;
  std::vector<std::shared_ptr<const Measurements>> beams_;
};

}  // namespace crisp
