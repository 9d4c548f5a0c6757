// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <crisp/context.hpp>
#include <crisp/registrar.hpp>
#include <crisp/stage.hpp>

#include "grabbers/emulate/emulator.hpp"

namespace crisp::emulate {

/// `emulate.rig`: is the devices that sent the scans and readings which it takes.
class EmulateStage final : public Stage {
 public:
  static void describe(StageDescription<EmulateStage>& d);

  void check(const RunSettings& run) const override;
  void process(const Inputs& in, Outputs& out, Context& context) override;
  void finish(Outputs& out, Context& context) override;

 private:
  void report_missing(Context& context);
  bool waits_no_longer(Context& context);

  EmulatorSettings settings_;
  std::string plate_to_ = "127.0.0.1:4000";
  std::unique_ptr<Emulator> emulator_;
  std::optional<std::vector<std::string>> missing_;  ///< lasers without a client, as they were reported
  std::uint64_t scans_ = 0;
  std::uint64_t readings_ = 0;
};

/// The emulator's stage.
void register_emulate(Registrar& registrar);

}  // namespace crisp::emulate
