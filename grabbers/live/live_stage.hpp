// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>

#include <crisp/context.hpp>
#include <crisp/registrar.hpp>
#include <crisp/stage.hpp>

#include "grabbers/live/live_source.hpp"

namespace crisp::live {

/// The devices of a rig that a live stage grabs.
enum class LiveDevices : std::uint8_t { LasersAndPlate, Lasers, Plate };

/// `grabber.live`, and of it the lasers alone, `grabber.sick`, or the plate alone, `grabber.plate`.
template <LiveDevices devices>
class LiveStage final : public Stage {
 public:
  static constexpr bool kLasers = devices != LiveDevices::Plate;
  static constexpr bool kPlate = devices != LiveDevices::Lasers;

  static void describe(StageDescription<LiveStage>& d);

  void check(const RunSettings& run) const override;
  void process(const Inputs& in, Outputs& out, Context& context) override;

 private:
  static void describe_configuration(StageDescription<LiveStage>& d);
  static void describe_plate(StageDescription<LiveStage>& d);
  static void give(const HubItem& item, Outputs& out);
  std::string running(double elapsed) const;
  void report(const CaptureStatistics& statistics, Context& context) const;

  LiveSettings settings_{.lasers = kLasers, .plate = kPlate};
  std::optional<double> duration_;
};

/// The live stages.
void register_live(Registrar& registrar);

}  // namespace crisp::live
