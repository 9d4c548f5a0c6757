// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>
#include <variant>
#include <vector>

#include <crisp/context.hpp>
#include <crisp/stage.hpp>

#include "plugins/diagnose/scans/interleave.hpp"
#include "plugins/diagnose/scans/stationary_fit_test.hpp"

namespace crisp::diagnose {

/// Stage `diagnose.stationary`: tests stationary scans for systematic differences between scan classes.
class DiagnoseStationaryStage final : public Stage {
 public:
  static void describe(StageDescription<DiagnoseStationaryStage>& d);

  void process(const Inputs& in, Outputs& out, Context& context) override;
  void finish(Outputs& out, Context& context) override;

 private:
  void diagnose(std::size_t index, Findings& findings, Context& context);
  static void report(const std::string& name, const ScanInterleave& interleave,
                     const std::vector<ClassOffset>& class_offsets, Context& context);
  void draw(const std::string& name, const std::vector<ClassOffset>& class_offsets, Context& context) const;
  std::shared_ptr<const Scan> corrected(const std::shared_ptr<const Scan>& scan);

  /// Scans of one laser, with the angular shift of each scan class [rad].
  struct Laser {
    ScanSeries series;
    std::size_t period = 1;
    std::vector<double> shifts;
    std::size_t next = 0;  ///< index of the next scan to output
  };
  std::optional<std::filesystem::path> folder_;
  bool correct_ = true;
  std::vector<Laser> lasers_;
  std::vector<std::variant<std::size_t, PlateReading>>
      items_;  ///< in order of receipt; index of a scan's laser
  std::vector<data::GoodnessOfFit> reported_;
  Findings findings_;  // including those of earlier stages
};

}  // namespace crisp::diagnose
