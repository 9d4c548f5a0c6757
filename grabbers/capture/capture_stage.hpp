// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

#include <crisp/capture_reader.hpp>
#include <crisp/context.hpp>
#include <crisp/error.hpp>
#include <crisp/stage.hpp>

namespace crisp::capture {

/// `grabber.capture`: gives the scans and readings of a capture of the hub's network interface, or of a
/// folder of captures.
class CaptureStage final : public Stage {
 public:
  static void describe(StageDescription<CaptureStage>& d);

  void check(const RunSettings& run) const override;
  void process(const Inputs& in, Outputs& out, Context& context) override;

 private:
  CaptureStatistics read(const std::filesystem::path& file, double done, double share, Outputs& out,
                         Context& context);
  void refuse_overlap(std::int64_t first_ns, const std::filesystem::path& file) const;
  void give(const HubItem& item, Outputs& out, Context& context);
  static std::uint64_t report(const CaptureStatistics& statistics, const std::filesystem::path& file,
                              Context& context);

  /// @param others  that speak in it, for people
  Error nothing_found(const std::string& others) const;
  Error nothing_left() const;

  std::filesystem::path file_;
  CaptureSettings settings_;
  double begin_ = 0;
  std::optional<double> duration_;
  std::optional<std::int64_t> first_ns_;  // of the first packet of all
  std::filesystem::path before_;          // the capture before the present one
  std::int64_t last_ns_ = 0;              // of its last packet
  std::uint64_t given_ = 0;               // items
};

}  // namespace crisp::capture
