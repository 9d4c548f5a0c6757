// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>
#include <variant>
#include <vector>

#include "pipeline/stage/context.hpp"
#include "pipeline/stage/description.hpp"
#include "plugins/scans/alternation.hpp"
#include "plugins/scans/told_at_rest.hpp"

namespace crisp {

/// `diagnose.rest`: whether the scans of a laser at rest are all alike.
class DiagnoseRestStage final : public Stage {
 public:
  static void describe(StageDescription<DiagnoseRestStage>& d);

  void process(const Inputs& in, Outputs& out, Context& context) override;
  void finish(Outputs& out, Context& context) override;

 private:
  void diagnose(std::size_t index, Findings& findings, Context& context);
  static void report(const std::string& name, const Alternation& alternation,
                     const std::vector<KindDeparture>& departures, Context& context);
  void draw(const std::string& name, const std::vector<KindDeparture>& departures, Context& context) const;
  std::shared_ptr<const Scan> mended(const std::shared_ptr<const Scan>& scan);

  /// What a laser's scans showed, and by how much each kind of them points further than it says [rad].
  struct Laser {
    ScanSeries series;
    std::size_t period = 1;
    std::vector<double> shifts;
    std::size_t next = 0;  ///< of the series, to be given
  };
  std::optional<std::filesystem::path> folder_;
  bool mend_ = true;
  std::vector<Laser> lasers_;
  std::vector<std::variant<std::size_t, PlateReading>> items_;  ///< as they came; of a scan, whose it was
  std::vector<ToldApart> told_;
  Findings findings_;  // what diagnoses above it said, and then its own
};

}  // namespace crisp
