// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>

#include "grabbers/simulate/link.hpp"
#include "grabbers/simulate/recording_settings.hpp"
#include "grabbers/simulate/sweep.hpp"
#include "grabbers/wire/scan_data.hpp"
#include "pipeline/statistics/random_stream.hpp"

namespace crisp::simulate {

/// A telegram as it reached the hub.
struct LaserTelegram {
  std::uint16_t laser = 0;      ///< index in the rig
  std::int64_t receipt_ns = 0;  ///< [ns since the Unix epoch] hub time at which it was complete
  wire::ScanData data;
};

/// One laser as a device: stamps its sweeps with its own clock, counts them, and sends them as telegrams.
class LaserUnit {
 public:
  /// @param index  of the laser in the rig
  /// @throws Error if what the laser is to measure does not fit its telegrams
  LaserUnit(const RecordingSettings& settings, const RecordingTruth& truth, std::uint16_t index);

  /// The telegram of the next sweep; nothing if it is lost, the device is silent, or started again meanwhile.
  std::optional<LaserTelegram> send(const Sweep& sweep);
  /// [s] Hub time of the sweep's stamp.
  double stamp_of(const Sweep& sweep) const;

 private:
  void fill_header(wire::ScanData& data, const Sweep& sweep, double sent);
  void fill_channels(wire::ScanData& data, const Sweep& sweep) const;

  RecordingSettings settings_;
  DeviceTruth truth_;
  RigLaser rig_;
  ScanPattern pattern_;
  std::uint16_t index_;
  Link link_;
  statistics::RandomStream handover_;
  statistics::RandomStream losses_;
  std::uint16_t scan_counter_ = 0;
  std::uint16_t counter_difference_ = 0;  ///< telegram counter − scan counter
  std::size_t restarts_ = 0;
  unsigned scans_since_start_ = 0;
};

}  // namespace crisp::simulate
