// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <memory>
#include <optional>

#include <crisp/calibration.hpp>
#include <crisp/context.hpp>
#include <crisp/findings.hpp>
#include <crisp/stage.hpp>

#include "pipeline/data/oriented_plate.hpp"
#include "pipeline/estimate/measurement_buffer.hpp"

namespace crisp::report {

/// `write.report`: the run as one HTML page.
class WriteReportStage final : public Stage {
 public:
  static void describe(StageDescription<WriteReportStage>& d);
  void process(const Inputs& in, Outputs& out, Context& context) override;
  void finish(Outputs& out, Context& context) override;

 private:
  std::filesystem::path file_;
  std::size_t points_ = 300'000;
  std::optional<std::filesystem::path> against_;

  static constexpr std::size_t kMaxBeams = 2'000'000;  ///< that points are chosen from
  estimate::MeasurementBuffer collected_{kMaxBeams};
  bool has_beams_ = false;
  data::OrientedPlate oriented_;
  std::shared_ptr<const Calibration> calibration_;
  std::shared_ptr<const Findings> findings_;
};

}  // namespace crisp::report
