// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include <crisp/context.hpp>
#include <crisp/measurements.hpp>
#include <crisp/plate_trajectory.hpp>
#include <crisp/stage_description.hpp>

#include "grabbers/velodyne/velodyne_packet.hpp"

namespace crisp {

/// `grabber.velodyne`: a VLP-16 as sixteen lasers with a fixed beam each on one turning plate.
class VelodyneStage final : public Stage {
 public:
  static void describe(StageDescription<VelodyneStage>& d);

  void check(const RunSettings& run) const override;
  void process(const Inputs& in, Outputs& out, Context& context) override;

 private:
  void take(const VelodynePacket& packet, std::int64_t receipt_ns, const Rig& rig);
  /// Gives the beams until then [s since the epoch], with the plate's trajectory over them.
  void give_until(double time, Outputs& out);

  std::filesystem::path file_;
  std::optional<std::int64_t> epoch_ns_;
  std::uint32_t last_us_ = 0;
  double packet_time_ = 0;  ///< [s since the epoch] of the last packet, by the device's clock
  double first_angle_ = 0, first_time_ = 0;
  std::vector<double> times_, angles_;  ///< that are needed for beams that were not given yet
  std::vector<Measurements> beams_;     ///< a packet each
};

}  // namespace crisp
