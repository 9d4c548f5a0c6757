// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>

#include <crisp/scan.hpp>

#include "grabbers/simulate/link.hpp"
#include "grabbers/simulate/motion.hpp"
#include "grabbers/simulate/recording_settings.hpp"
#include "pipeline/statistics/random_stream.hpp"

namespace crisp::simulate {

/// The plate's encoder as a device: reads it at a steady rate of its own clock and reports each reading.
class PlateUnit {
 public:
  /// @param motion  kept by reference
  /// @param begin   [s] hub time of the first reading
  PlateUnit(const RecordingSettings& settings, const RecordingTruth& truth, const Motion& motion,
            double begin);

  /// Hub time [s] of the next reading.
  double next_time() const { return time_; }

  /// The next reading; nothing if it is lost or the device is silent.
  std::optional<PlateReading> send();

 private:
  RecordingSettings settings_;
  DeviceTruth truth_;
  const Motion* motion_;
  Link link_;
  statistics::RandomStream losses_;
  double begin_;
  double time_;
  std::uint64_t readings_ = 0;
  std::uint16_t sequence_ = 0;
  std::size_t restarts_ = 0;
};

}  // namespace crisp::simulate
