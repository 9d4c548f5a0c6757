// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "pipeline/data/findings.hpp"
#include "pipeline/stage/context.hpp"
#include "pipeline/stage/description.hpp"
#include "plugins/diagnose/at_rest.hpp"
#include "plugins/diagnose/told_apart.hpp"

namespace crisp {

/// Says how the ranges of lasers that stand still scatter, and what they do together.
class DiagnoseNoiseStage final : public Stage {
 public:
  static void describe(StageDescription<DiagnoseNoiseStage>& d);
  void process(const Inputs& in, Outputs& out, Context& context) override;
  void finish(Outputs& out, Context& context) override;

 private:
  void add_laser(const std::string& name, const AtRest& scans, Findings& all, Context& context);

  std::optional<std::filesystem::path> folder_;
  std::vector<AtRest> lasers_;  // of the rig
  PlateRest plate_;
  std::int64_t first_ns_ = 0;  // receipt of the first scan
  std::vector<ToldApart> told_;
  Findings all_;  // what other diagnoses said before
};

}  // namespace crisp
