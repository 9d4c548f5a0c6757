// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>

#include <crisp/context.hpp>
#include <crisp/stage.hpp>

#include "grabbers/devices/rotating_head.hpp"
#include "grabbers/velodyne/velodyne_packet.hpp"

namespace crisp::velodyne {

/// `grabber.velodyne`: a VLP-16 as sixteen lasers with a fixed beam each on one turning plate.
class VelodyneStage final : public Stage {
 public:
  static void describe(StageDescription<VelodyneStage>& d);

  void check(const RunSettings& run) const override;
  void process(const Inputs& in, Outputs& out, Context& context) override;

 private:
  void take(const VelodynePacket& packet, std::int64_t receipt_ns, const Rig& rig);

  std::filesystem::path file_;
  std::optional<devices::RotatingHead> head_;  ///< from the first packet on
  std::uint32_t last_us_ = 0;
  double packet_time_ = 0;  ///< [s since the epoch] of the last packet, by the device's clock
};

}  // namespace crisp::velodyne
