// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>

#include "grabbers/capture/capture_reader.hpp"
#include "pipeline/stage/context.hpp"
#include "pipeline/stage/description.hpp"

namespace crisp {

/// `grabber.capture`: gives the scans and readings of a capture of the hub's network interface.
class CaptureStage final : public Stage {
 public:
  static void describe(StageDescription<CaptureStage>& d);

  void check(const RunSettings& run) const override;
  void process(const Inputs& in, Outputs& out, Context& context) override;

 private:
  void give(const HubItem& item, std::int64_t first_ns, Outputs& out, Context& context) const;
  void report(const CaptureStatistics& statistics, Context& context) const;

  std::filesystem::path file_;
  CaptureSettings settings_;
  double begin_ = 0;
  std::optional<double> duration_;
};

}  // namespace crisp
